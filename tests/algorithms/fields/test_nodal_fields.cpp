// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/meshing.h"

namespace delquad {
namespace {

/// The unit square at height z: a quad below the line y = 0.5, two triangles above.
Mesh square(double z = 0) {
  Mesh mesh;
  mesh.points = {{0, 0, z}, {1, 0, z}, {1, 0.5, z}, {0, 0.5, z}, {1, 1, z}, {0, 1, z}};
  mesh.quads = {{0, 1, 2, 3}};
  mesh.quad_region = {0};
  mesh.triangles = {{3, 2, 4}, {3, 4, 5}};
  mesh.triangle_region = {0, 0};
  mesh.regions = {{1, {}}};
  return mesh;
}

std::vector<double> values(const Mesh& mesh, double (*f)(const Vec3&)) {
  std::vector<double> all;
  for (const Vec3& p : mesh.points) all.push_back(f(p));
  return all;
}

TEST(NodalSize, IsLinearAndThatOfTheNearestPointOutside) {
  const auto f = [](const Vec3& x) { return 1 + x.x + 3 * x.y; };
  const Mesh mesh = square();
  const auto size = make_nodal_size(mesh, values(mesh, f));
  for (const Vec3 x : {Vec3{0.1, 0.2, 0}, Vec3{0.9, 0.1, 0}, Vec3{0.3, 0.5, 0}, Vec3{0.2, 0.9, 0}})
    for (int hint = -1; hint < 5; ++hint) {
      int where = hint;
      EXPECT_NEAR(size->at(x, where), f(x), 1e-14);
    }
  int hint = 0;
  EXPECT_NEAR(size->at({2, 0.25, 7}, hint), f({1, 0.25, 0}), 1e-14);
}

TEST(NodalSize, HintsDoNotChangeTheValue) {
  const Mesh mesh = square();
  const auto size = make_nodal_size(mesh, {0.1, 0.7, 0.3, 0.9, 0.2, 0.4});
  for (int i = 0; i <= 40; ++i)
    for (int j = 0; j <= 40; ++j) {
      const Vec3 x{i / 30.0 - 0.1, j / 30.0 - 0.1, 0};
      int none = -1;
      const double without = size->at(x, none);
      for (int hint = 0; hint < 4; ++hint) {
        int where = hint;
        EXPECT_EQ(size->at(x, where), without);
      }
    }
}

TEST(NodalSize, RefusesWhatDoesNotFit) {
  EXPECT_EQ(message_of([] {
              make_nodal_size(square(), {1, 1});
            }),
            "the mesh of the nodal size has 6 points, but there are 2 values: expected one for each");
  EXPECT_EQ(message_of([] {
              make_nodal_size(square(), {1, 1, 1, -1, 1, 1});
            }),
            "the nodal size 3 is -1 at (0, 0.5, 0): expected a finite length > 0 [bad-size]");
  EXPECT_EQ(message_of([] { make_nodal_size({}, {}); }),
            "the mesh of the nodal size has neither triangles nor quads");
  Mesh broken = square();
  broken.triangles[1][2] = 6;
  EXPECT_EQ(message_of([&] { make_nodal_size(broken, std::vector<double>(6, 1)); }),
            "the mesh of the nodal size: triangle 1 has point 6: there are 6, counted from 0");
}

TEST(NodalCross, InterpolatesTheCrossNotTheAngle) {
  // Angles that differ by quarters of a turn are the same cross.
  constexpr double kQuarter = 1.5707963267948966;
  const Mesh mesh = square(3);
  const auto cross =
      make_nodal_cross(mesh, {0.2, 0.2 + kQuarter, 0.2, 0.2 - kQuarter, 0.2, 0.2 + 2 * kQuarter});
  int hint = -1;
  EXPECT_NEAR(cross->at({0.4, 0.3}, hint).angle(), 0.2, 1e-12);
  EXPECT_NEAR(cross->at({0.4, 0.8}, hint).angle(), 0.2, 1e-12);
}

TEST(NodalCross, RefusesWhatDoesNotFit) {
  Mesh bent = square();
  bent.points[4].z = 1;
  expect_input_error([&] { make_nodal_cross(bent, std::vector<double>(6, 0)); }, {"is not planar: point 4"});
  expect_input_error([] { make_nodal_cross(square(), {0, NAN, 0, 0, 0, 0}); }, {"angle 1 is nan"});
}

}  // namespace
}  // namespace delquad
