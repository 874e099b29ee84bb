// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/mesh/delaunay_kernel.h"
#include "tests/support/meshing.h"

namespace delquad {
namespace {

/// Every side is constrained or locally Delaunay.
bool is_constrained_delaunay(const TriPatch& tri) {
  for (size_t t = 0; t < tri.triangles.size(); ++t) {
    const auto& v = tri.triangles[t];
    for (int k = 0; k < 3; ++k) {
      const int n = tri.neighbours[t][k];
      if (n < 0) continue;
      for (const int w : tri.triangles[n]) {
        if (w != v[0] && w != v[1] && w != v[2] &&
            in_circle(tri.points[v[0]], tri.points[v[1]], tri.points[v[2]], tri.points[w]) > 0) {
          return false;
        }
      }
    }
  }
  return true;
}

int insert_anywhere(DelaunayKernel& kernel, Vec2 x, int start) {
  const int t = kernel.locate(x, start);
  if (t < 0 || !kernel.find_cavity(x, t)) return start;
  return kernel.insert(x)[0];
}

TEST(DelaunayKernel, StaysConstrainedDelaunayOnRandomPolygons) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    const auto boundary = shapes::random_polygon_with_holes(seed);
    DelaunayKernel kernel(constrained_delaunay(boundary));
    std::mt19937_64 random(seed);
    int near = 0;
    for (int i = 0; i < 300; ++i) {
      near =
          insert_anywhere(kernel, {2 * shapes::uniform(random) - 1, 2 * shapes::uniform(random) - 1}, near);
    }
    const TriPatch tri = kernel.to_patch(static_cast<int>(boundary.points.size()));
    EXPECT_GT(tri.points.size(), boundary.points.size());
    EXPECT_TRUE(check_invariants(tri).empty()) << seed;
    EXPECT_TRUE(is_constrained_delaunay(tri)) << seed;
  }
}

// A lattice: every cavity test is a tie, every second point lies on an edge.
TEST(DelaunayKernel, CocircularLattice) {
  const int n = 16;
  const auto boundary = shapes::rectangle(1, 1, n, n);
  DelaunayKernel kernel(constrained_delaunay(boundary));
  int near = 0;
  for (int i = 1; i < n; ++i) {
    for (int j = 1; j < n; ++j) near = insert_anywhere(kernel, {double(i) / n, double(j) / n}, near);
  }
  const TriPatch tri = kernel.to_patch(4 * n);
  EXPECT_EQ(tri.triangles.size(), 2u * n * n);
  EXPECT_TRUE(check_invariants(tri).empty());
  EXPECT_TRUE(is_constrained_delaunay(tri));
}

TEST(DelaunayKernel, RefusesPointsOnVerticesOnTheBoundaryAndOutside) {
  DelaunayKernel kernel(constrained_delaunay(shapes::rectangle(1, 1, 1, 1)));
  EXPECT_EQ(kernel.locate({2, 0.5}, 0), -1);
  EXPECT_FALSE(kernel.find_cavity({0, 0}, kernel.locate({0, 0}, 0)));
  EXPECT_FALSE(kernel.find_cavity({0.5, 0}, kernel.locate({0.5, 0}, 0)));
  EXPECT_TRUE(kernel.find_cavity({0.5, 0.5}, kernel.locate({0.5, 0.5}, 0)));
}

TEST(DelaunayKernel, ShellIsAClosedPolygonAroundThePoint) {
  DelaunayKernel kernel(constrained_delaunay(shapes::disk(1, 40)));
  ASSERT_TRUE(kernel.find_cavity({0.1, 0.2}, kernel.locate({0.1, 0.2}, 0)));
  const auto shell = kernel.shell();
  EXPECT_EQ(shell.size(), kernel.cavity().size() + 2);
  std::set<int> starts;
  for (size_t k = 0; k < shell.size(); ++k) {
    EXPECT_EQ(shell[k].b, shell[(k + 1) % shell.size()].a);
    EXPECT_TRUE(starts.insert(shell[k].a).second);
  }
}

}  // namespace
}  // namespace delquad
