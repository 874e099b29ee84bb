// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/mesh/nearest_triangle.h"
#include "smoothing/surface/surface_tracks.h"
#include "tests/smoothing/meshed_surface.h"
#include "tests/support/polygon_face.h"

namespace delquad {
namespace {

/// All patches of a model, meshed by DB, before and after their vertices slid.
struct Slid : MeshedSurface {
  Slid(SurfaceModel given, double h) : MeshedSurface(std::move(given), h, true) {
    std::vector<SurfaceTracks::Patch> patches;
    for (std::size_t p = 0; p < quads.size(); ++p) {
      const SurfacePatch& patch = domain.patches[p];
      int hint = -1;
      for (std::size_t i = patch.boundary.points.size(); i < quads[p].points.size(); ++i)
        inside[p].push_back(lift(patch, model, quads[p].points[i], hint));
      patches.push_back({&patch, crosses[p].get(), &quads[p], &inside[p]});
    }
    SurfaceTracks tracks(model, size, domain, nodes, patches);
    std::vector<Vec3> points = tracks.points();
    eta_before = mean_eta(points, tracks.quads());
    summary = optimise_on_tracks(points, tracks.quads(), tracks);
    eta_after = mean_eta(points, tracks.quads());
    tracks.store(points);
  }

  static double mean_eta(const std::vector<Vec3>& points, const std::vector<std::array<int, 4>>& quads) {
    Mesh mesh;
    mesh.points = points, mesh.quads = quads;
    double sum = 0;
    for (const double eta : quad_etas(mesh)) sum += eta;
    return sum / static_cast<double>(quads.size());
  }

  OptimisationSummary summary;
  double eta_before = 0, eta_after = 0;
};

void expect_on_tracks(const Slid& slid) {
  EXPECT_GT(slid.eta_after, slid.eta_before);
  int moved = 0;
  for (std::size_t c = 0; c < slid.nodes.on_curve.size(); ++c) {
    const auto& before = slid.domain.nodes.on_curve[c];
    const auto& after = slid.nodes.on_curve[c];
    ASSERT_EQ(before.size(), after.size());
    for (std::size_t k = 0; k < after.size(); ++k) {
      EXPECT_EQ(before[k].node, after[k].node);
      const Vec3 place = place_on_curve(slid.model, slid.domain.chains[c], slid.domain.cut_face, after[k].s);
      EXPECT_LT(norm(slid.nodes.points[after[k].node] - place), 1e-12);
      if (k > 0) {
        EXPECT_GT(after[k].s, after[k - 1].s);
      }
      const bool is_end = k == 0 || k + 1 == after.size();
      if (is_end) {
        EXPECT_EQ(after[k].s, before[k].s);
      }
      moved += after[k].s != before[k].s;
    }
  }
  EXPECT_GT(moved, 0);
  const NearestTriangle triangles(slid.model.fine.points, slid.model.fine.triangles);
  for (std::size_t p = 0; p < slid.quads.size(); ++p) {
    for (const Vec3& x : slid.inside[p]) EXPECT_LT(triangles.find(x).distance, 1e-9);
    // The boundary in the plane follows the nodes.
    const SurfacePatch& patch = slid.domain.patches[p];
    int hint = -1;
    for (std::size_t i = 0; i < patch.boundary.points.size(); ++i)
      EXPECT_LT(norm(lift(patch, slid.model, slid.quads[p].points[i], hint) -
                     slid.nodes.points[patch.boundary.point_node[i]]),
                1e-9);
  }
}

TEST(SurfaceTracks, NodesSlideAlongTheSidesOfAPolygon) {
  const Slid slid(polygon_face({{0, 0}, {7, 0}, {9, 5}, {3, 6}}, 0.2), 0.6);
  expect_on_tracks(slid);
}

TEST(SurfaceTracks, BumpWithoutCorners) { expect_on_tracks(Slid(bump(40, 0.5), 0.15)); }

TEST(SurfaceTracks, NodesSlideAlongTheCutOfACylinder) {
  const Slid slid(cylinder(60, 40, 1, 2), 0.21);
  ASSERT_FALSE(std::all_of(slid.domain.cut_face.begin(), slid.domain.cut_face.end(),
                           [](int face) { return face < 0; }));
  expect_on_tracks(slid);
}

TEST(SurfaceTracks, SameInputSameMesh) {
  const Slid a(bump(30, 0.5), 0.2), b(bump(30, 0.5), 0.2);
  EXPECT_EQ(a.nodes.points, b.nodes.points);
  EXPECT_EQ(a.inside, b.inside);
}

}  // namespace
}  // namespace delquad
