// SPDX-License-Identifier: GPL-3.0-or-later
#include "algorithms/fields/laplace.h"
#include "tests/algorithms/fields/backgrounds.h"

namespace delquad {
namespace {

double linear(Vec2 u) { return 2 * u.x - 3 * u.y + 1; }

/// Both elements reproduce linear functions exactly, on any triangulation.
void expect_linear(const BackgroundMesh& background) {
  const TriPatch& tri = background.triangles();
  const std::size_t n = tri.points.size();
  std::vector<char> fixed(n, 0);
  std::vector<double> columns[] = {std::vector<double>(n, 0), std::vector<double>(n, 5)};
  for (std::size_t i = 0; i < n; ++i) {
    fixed[i] = background.boundary_points()[i].from >= 0;
    if (fixed[i]) columns[0][i] = linear(tri.points[i]);
  }
  solve_laplace(tri, tri.triangles, fixed, columns);
  for (std::size_t i = 0; i < n; ++i) {
    EXPECT_NEAR(columns[0][i], linear(tri.points[i]), 1e-11);
    EXPECT_NEAR(columns[1][i], 5, 1e-11);
  }
}

void expect_linear_at_sides(const BackgroundMesh& background) {
  const TriPatch& tri = background.triangles();
  const Sides sides = number_sides(tri);
  std::vector<char> fixed(sides.count, 0);
  std::vector<double> columns[] = {std::vector<double>(sides.count, 0)}, expected(sides.count, 0);
  for (std::size_t t = 0; t < tri.triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const int side = sides.of_triangle[t][k];
      const Vec2 a = tri.points[tri.triangles[t][(k + 1) % 3]], b = tri.points[tri.triangles[t][(k + 2) % 3]];
      expected[side] = linear(0.5 * (a + b));
      fixed[side] = tri.neighbours[t][k] < 0;
      if (fixed[side]) columns[0][side] = expected[side];
    }
  }
  solve_laplace(tri, sides.of_triangle, fixed, columns);
  for (int i = 0; i < sides.count; ++i) EXPECT_NEAR(columns[0][i], expected[i], 1e-11);
}

TEST(Laplace, ReproducesLinearFunctions) {
  for (int seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(seed);
    const auto background = background_of(shapes::random_polygon_with_holes(seed));
    expect_linear(*background);
    expect_linear_at_sides(*background);
  }
}

// Two sides of the inner triangle have one place: no value of its third side reaches another.
TEST(Laplace, PointsMayCoincide) {
  TriPatch tri;
  tri.points = {{0, 0}, {1, 0}, {1, 0}, {0, 1}};
  tri.triangles = {{0, 1, 3}, {1, 2, 3}};
  const std::vector<std::array<int, 3>> dofs = {{0, 1, 2}, {3, 0, 4}};
  const std::vector<char> fixed = {0, 1, 1, 0, 0};
  std::vector<double> columns[] = {{0, 2, 2, 0, 0}};
  solve_laplace(tri, dofs, fixed, columns);
  for (const double value : columns[0]) EXPECT_NEAR(value, 2, 1e-6);
}

TEST(Laplace, StaysFiniteOnSlivers) {
  const auto background = background_of(shapes::polygon({{0, 0}, {1, 0}, {1, 1e-11}}, 10));
  const TriPatch& tri = background->triangles();
  std::vector<char> fixed(tri.points.size(), 0);
  std::vector<double> columns[] = {std::vector<double>(tri.points.size(), 0)};
  for (std::size_t i = 0; i < fixed.size(); ++i) {
    fixed[i] = background->boundary_points()[i].from >= 0;
    if (fixed[i]) columns[0][i] = tri.points[i].x;
  }
  solve_laplace(tri, tri.triangles, fixed, columns);
  for (const double value : columns[0]) EXPECT_TRUE(std::isfinite(value));
}

}  // namespace
}  // namespace delquad
