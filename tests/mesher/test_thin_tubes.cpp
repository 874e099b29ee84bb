// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/surface/surface_editor.h"
#include "mesher/runner.h"
#include "metrics/judgement/poor_quads.h"
#include "tests/support/meshing.h"
#include "tests/support/polygon_face.h"

namespace delquad {
namespace {

/// Elements do not meet themselves, and no two have the same vertices.
MeshResult mesh_of(SurfaceModel model, double size, const char* word) {
  MeshResult result = meshed(std::move(model), size, word);
  EXPECT_EQ(check_invariants(result.mesh), std::vector<std::string>{});
  return result;
}

double worst_eta(const Mesh& mesh) {
  const std::vector<double> etas = quad_etas(mesh);
  return *std::min_element(etas.begin(), etas.end());
}

TEST(ThinTubes, QuadsDoNotMeetThemselvesAround) {
  for (const double size : {0.2, 0.5, 1.0, 2.0}) {
    const MeshResult result = mesh_of(cylinder(16, 96, 0.1, 4), size, "DB");
    EXPECT_TRUE(result.mesh.triangles.empty());
    EXPECT_EQ(result.surface->mesh.euler_characteristic, 0);
    EXPECT_GT(worst_eta(result.mesh), 0.3) << size;
  }
}

/// A ring of quads that is cut open: its first nodes are its last ones, too.
TEST(ThinTubes, TwoQuadsAroundHaveTheSameNodes) {
  for (const int n : {2, 3, 4}) {
    QuadPatch ring;
    std::vector<int> node;
    for (const int row : {0, 1})
      for (int k = 0; k <= n; ++k) {
        ring.points.push_back({double(k), double(row)});
        node.push_back(n * row + k % n);
      }
    for (int k = 0; k < n; ++k) ring.quads.push_back({k, k + 1, n + k + 2, n + k + 1});
    ring.n_boundary = static_cast<int>(node.size());
    EXPECT_EQ(has_duplicate_quads(ring, node), n == 2) << n;
  }
}

TEST(ThinTubes, TwoQuadsMeetAtAPointedTip) {
  for (const double degrees : {2, 5, 10, 20, 33}) {
    const double half_angle = degrees * std::numbers::pi / 180;
    for (const double size : {0.07, 0.2}) {
      const MeshResult result = mesh_of(cone(48, 24, half_angle), size, "DB");
      EXPECT_EQ(result.surface->mesh.euler_characteristic, 1);
      const auto at_tip = std::ranges::count_if(result.mesh.quads, [&](const auto& quad) {
        return std::ranges::any_of(quad, [&](int v) { return norm(result.mesh.points[v]) < 1e-12; });
      });
      EXPECT_EQ(at_tip, 2) << degrees << " " << size;
      // Their sides lie on opposite generators.
      EXPECT_GT(worst_eta(result.mesh), std::min(0.3, 0.95 * degrees / 45)) << degrees << " " << size;
      EXPECT_EQ(result.bad_elsewhere, 0);
    }
  }
}

TEST(ThinTubes, ATipDoesNotKeepTheRestFromTreatment) {
  // Where treatment leaves but two quads around, the whole patch keeps what the matching left: flat boundary
  // corners.
  for (const auto& [half_angle, n] : {std::pair(0.05, 76), {0.05, 88}, {0.066, 64}, {0.09, 94}})
    EXPECT_EQ(mesh_of(cone(48, 64, half_angle), 1.0 / n, "DB").bad_elsewhere, 0) << half_angle << " " << n;
}

TEST(ThinTubes, VerticesMoveBesideTips) {
  const MeshResult result = mesh_of(cone(48, 24, 0.15), 0.1, "DBO");
  EXPECT_EQ(result.surface->mesh.euler_characteristic, 1);
  EXPECT_GT(worst_eta(result.mesh), 0.9 * 0.15 / (std::numbers::pi / 4));
}

TEST(SharpCorners, ExplainQuadsThatReachTheirBoundOnly) {
  const MeshingSetup prepared =
      prepare_surface({}, polygon_face({{0, 0}, {6, -0.2}, {6, 0.2}}, 0.1), make_constant_size(0.5));
  ASSERT_EQ(prepared.surface->domain.sharp_corners.size(), 1u);
  EXPECT_LT(prepared.surface->domain.sharp_corners[0].eta_bound, 0.1);
  MeshResult result = meshed(prepared, "DB");
  EXPECT_EQ(check_invariants(result.mesh), std::vector<std::string>{});
  EXPECT_EQ(result.bad_in_corners, 1);
  EXPECT_EQ(result.bad_elsewhere, 0);
  // A corner of its quad that opens to nearly 180 degrees is worse than the model's.
  for (const auto& v : result.mesh.quads) {
    const auto tip = std::ranges::find_if(v, [&](int i) { return norm(result.mesh.points[i]) == 0; });
    if (tip == v.end()) continue;
    const auto at = [&](int k) -> Vec3& { return result.mesh.points[v[(tip - v.begin() + k) % 4]]; };
    at(2) = at(1) + 0.505 * (at(3) - at(1));
  }
  const BadQuads bad =
      judge_quads(prepared, "spoilt", result.mesh, result.metrics, result.warnings, result.soundness);
  EXPECT_EQ(bad.in_corners, 0);
  EXPECT_GE(bad.elsewhere, 1);
}

/// A square of side 10 with a slit from the middle of a side to its center, in so many lines.
SurfaceModel slit_square(int lines) {
  const int n = 2 * lines;
  SurfaceModel model = grid_surface({n, n}, [](double u, double v) { return Vec3{10 * u, 10 * v, 0}; });
  std::vector<int> chain;
  for (int i = 0; i <= lines; ++i) {
    const Vec3 x{5.0 * i / lines, 5, 0};
    const auto at =
        std::ranges::find_if(model.fine.points, [&](const Vec3& p) { return norm(p - x) < 1e-9; });
    chain.push_back(static_cast<int>(at - model.fine.points.begin()));
  }
  SurfaceEditor editor(model);
  editor.add_curve(chain);
  editor.finish();
  model.corners = {chain.front(), chain.back()};
  std::ranges::sort(model.corners);
  return model;
}

TEST(ThinTubes, ASlitIsNone) {
  for (const int lines : {1, 5})
    for (const double size : {0.5, 1.0, 2.0}) {
      const MeshResult result = mesh_of(slit_square(lines), size, "DB");
      EXPECT_LT(static_cast<double>(result.mesh.quads.size()), 1.5 * 100 / (size * size))
          << lines << " " << size;
      EXPECT_GT(worst_eta(result.mesh), 0.3) << lines << " " << size;
    }
}

TEST(ThinTubes, TrianglesCoverThemToo) {
  EXPECT_EQ(mesh_of(cylinder(16, 96, 0.1, 4), 1, "D").surface->mesh.euler_characteristic, 0);
  EXPECT_EQ(mesh_of(cone(48, 24, 0.15), 0.2, "D").surface->mesh.euler_characteristic, 1);
}

}  // namespace
}  // namespace delquad
