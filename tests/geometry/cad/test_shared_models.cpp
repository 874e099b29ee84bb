// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/surface/compound.h"
#include "tests/geometry/cad/cad_files.h"
#include "tests/support/shared_data.h"

namespace delquad {
namespace {

struct Expected {
  const char* file;
  std::size_t faces, curves;
  int euler;
  double area;  ///< integrated over the true surfaces
  bool closed = true;
};

void PrintTo(const Expected& expected, std::ostream* out) { *out << expected.file; }

std::filesystem::path data_folder() { return shared_data("cad"); }

class SharedModels : public ::testing::TestWithParam<Expected> {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(data_folder() / GetParam().file))
      GTEST_SKIP() << "data not found: " << data_folder() / GetParam().file;
  }
};

TEST_P(SharedModels, AreWholeConformingAndOutward) {
  const Expected& expected = GetParam();
  const SurfaceModel model = read_cad(data_folder() / expected.file);
  EXPECT_EQ(check_invariants(model.fine), std::vector<std::string>{});
  expect_sound(model);
  EXPECT_EQ(model.fine.regions.size(), expected.faces);
  EXPECT_EQ(model.fine.curves.size(), expected.curves);
  const SurfaceCounts n = count(model.fine);
  EXPECT_EQ(n.euler, expected.euler);
  EXPECT_EQ(n.free_sides == 0, expected.closed);
  EXPECT_EQ(n.crowded_sides, 0);
  constexpr double kArea = 5e-3;
  EXPECT_NEAR(n.area / expected.area, 1, kArea);
  if (expected.closed) {
    EXPECT_GT(n.volume, 0);
  }
}

TEST_P(SharedModels, ProjectToTheirSurfacesAndCurves) {
  const SurfaceModel model = read_cad(data_folder() / GetParam().file);
  const Mesh& mesh = model.fine;
  // The deflection is 1/2000 of the kernel's box, somewhat larger than ours. One free-form surface of A319
  // folds onto itself at a tip, where points of both sheets, 2e-9 apart, are foot points.
  const double near = 6e-4 * diagonal(mesh), same = 5e-9 * diagonal(mesh);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    const Vec3 x = 1.0 / 3 * (mesh.points[a] + mesh.points[b] + mesh.points[c]);
    const Vec3 y = model.projector->to_face(mesh.triangle_region[t], x);
    EXPECT_LT(norm(y - x), near) << t;
    EXPECT_LT(norm(model.projector->to_face(mesh.triangle_region[t], y) - y), same) << t;
  }
  for (std::size_t l = 0; l < mesh.lines.size(); ++l) {
    const Vec3 x = 0.5 * (mesh.points[mesh.lines[l][0]] + mesh.points[mesh.lines[l][1]]);
    const Vec3 y = model.projector->to_curve(mesh.line_curve[l], x);
    EXPECT_LT(norm(y - x), near) << l;
    EXPECT_LT(norm(model.projector->to_curve(mesh.line_curve[l], y) - y), same) << l;
  }
}

TEST_P(SharedModels, FromTheirOutlinesAreTheSame) {
  const SurfaceModel kernel = read_cad(data_folder() / GetParam().file),
                     own = read_cad(data_folder() / GetParam().file, {.by_outline = true});
  EXPECT_EQ(check_invariants(own.fine), std::vector<std::string>{});
  expect_sound(own);
  EXPECT_EQ(own.fine.curves.size(), kernel.fine.curves.size());
  EXPECT_EQ(own.corners.size(), kernel.corners.size());
  const SurfaceCounts n = count(own.fine);
  EXPECT_EQ(n.euler, GetParam().euler);
  EXPECT_EQ(n.free_sides == 0, GetParam().closed);
  EXPECT_EQ(n.crowded_sides, 0);
  constexpr double kArea = 5e-3;
  EXPECT_NEAR(n.area / GetParam().area, 1, kArea);
}

INSTANTIATE_TEST_SUITE_P(All, SharedModels,
                         ::testing::Values(Expected{"A319.brep", 83, 368, 2, 654292384},
                                           Expected{"Kurbelwelle.stp", 58, 145, -2, 2347.6786},
                                           Expected{"capot.brep", 18, 51, 1, 1519319.03, false},
                                           Expected{"linkrods.step", 37, 99, -2, 32.1514208},
                                           Expected{"mambo_m1.step", 42, 114, -16, 43466.2531},
                                           Expected{"mambo_m4.step", 38, 102, -4, 1354.1426},
                                           Expected{"mambo_m7.step", 112, 280, -20, 32575.3817},
                                           Expected{"mambo_s1.step", 14, 36, -4, 51020.2128},
                                           Expected{"mambo_s24.step", 24, 65, -4, 49947.3117},
                                           Expected{"mambo_s34.step", 46, 119, -4, 24631.3213},
                                           Expected{"mambo_s7.step", 10, 19, -2, 51924.6651},
                                           Expected{"mambo_simp.step", 11, 27, 0, 32756.6863},
                                           Expected{"part.step", 26, 68, 2, 49611.5609},
                                           Expected{"pump_carter.stp", 119, 295, -16, 240818.815}),
                         [](const auto& param) {
                           std::string name = param.param.file;
                           std::ranges::replace(name, '.', '_');
                           return name;
                         });

TEST(SharedHood, HasItsOutlineAndSlivers) {
  const auto path = data_folder() / "capot.brep";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "data not found: " << path;
  const SurfaceModel model = read_cad(path);
  const Mesh& mesh = model.fine;
  std::vector<double> length(mesh.curves.size(), 0);
  double outline = 0;
  for (std::size_t l = 0; l < mesh.lines.size(); ++l)
    length[mesh.line_curve[l]] += norm(mesh.points[mesh.lines[l][0]] - mesh.points[mesh.lines[l][1]]);
  const std::vector<HalfEdge> sides = sorted_half_edges(mesh);
  for_each_edge(sides, [&](std::span<const HalfEdge> edge) {
    if (edge.size() == 1) outline += norm(mesh.points[edge[0].lo] - mesh.points[edge[0].hi]);
  });
  EXPECT_NEAR(outline, 5384, 2);
  for (std::size_t c = 0; c < mesh.curves.size(); ++c) {
    const int tag = mesh.curves[c].tag;
    if (tag == 44 || tag == 47) {
      EXPECT_NEAR(length[c], 1.18, 0.01) << tag;
    } else {
      EXPECT_GT(length[c], 2) << tag;
    }
  }
}

TEST(SharedHood, ACompoundProjectsToTheFaceUnderneath) {
  const auto path = data_folder() / "capot.brep";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "data not found: " << path;
  const SurfaceModel parts = read_cad(path);
  const SurfaceModel whole = make_compound(parts, tangent_groups(parts, 180));
  ASSERT_EQ(whole.fine.regions.size(), 1u);
  const Mesh& mesh = parts.fine;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    const Vec3 x = 1.0 / 3 * (mesh.points[a] + mesh.points[b] + mesh.points[c]);
    EXPECT_EQ(whole.projector->to_face(0, x), parts.projector->to_face(mesh.triangle_region[t], x)) << t;
  }
}

}  // namespace
}  // namespace delquad
