// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/meshing.h"

namespace delquad {
namespace {

double area(const TriPatch& tri) {
  double sum = 0;
  for (const auto& t : tri.triangles) {
    sum += cross(tri.points[t[1]] - tri.points[t[0]], tri.points[t[2]] - tri.points[t[0]]) / 2;
  }
  return sum;
}

double enclosed_area(const PatchBoundary& boundary) {
  double sum = 0;
  for (const auto& e : boundary.edges) sum += cross(boundary.points[e[0]], boundary.points[e[1]]) / 2;
  return sum;
}

// T = 2 V_interior + V_boundary + 2 H - 2.
TEST(ConstrainedDelaunay, CountsAndAreaOfRandomPolygonsWithHoles) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    const PatchBoundary boundary = shapes::random_polygon_with_holes(seed, seed % 2 ? 0.1 : 0);
    const TriPatch tri = constrained_delaunay(boundary);
    EXPECT_TRUE(check_invariants(tri).empty()) << seed;
    EXPECT_NEAR(area(tri), enclosed_area(boundary), 1e-12) << seed;
    int loops = 0;
    std::vector<int> next(boundary.points.size());
    for (const auto& e : boundary.edges) next[e[0]] = e[1];
    std::vector<char> seen(next.size(), 0);
    for (size_t i = 0; i < next.size(); ++i) {
      if (!seen[i]) ++loops;
      for (size_t j = i; !seen[j]; j = next[j]) seen[j] = 1;
    }
    EXPECT_EQ(tri.triangles.size(), boundary.points.size() + 2 * (loops - 1) - 2) << seed;
  }
}

TEST(ConstrainedDelaunay, TakesInteriorPointsInOrder) {
  const auto boundary = shapes::rectangle(1, 1, 4, 4);
  const TriPatch tri = constrained_delaunay(boundary, {{0.5, 0.5}, {0.25, 0.75}});
  EXPECT_EQ(tri.n_boundary, 16);
  EXPECT_EQ(tri.points[16], (Vec2{0.5, 0.5}));
  EXPECT_EQ(tri.points[17], (Vec2{0.25, 0.75}));
  EXPECT_EQ(tri.triangles.size(), 2u * 2 + 16 - 2);
  EXPECT_TRUE(check_invariants(tri).empty());
}

TEST(ConstrainedDelaunay, RefusesWhatIsNotAPatch) {
  const auto square = shapes::rectangle(1, 1, 2, 2);
  EXPECT_THROW(constrained_delaunay(square, {{2, 2}}), InputError);
  EXPECT_THROW(constrained_delaunay(square, {{0.5, 0.5}, {0.5, 0.5}}), InputError);
  EXPECT_THROW(constrained_delaunay(square, {{0.25, 0}}), InputError);
  EXPECT_THROW(constrained_delaunay(shapes::polygon({{0, 0}, {1, 1}, {1, 0}, {0, 1}})), InputError);
}

TEST(ConstrainedDelaunay, RefusesHolesThatAreTurnedInsideOut) {
  // Meshed on both sides, its edges would be edges of no boundary.
  const std::vector<Vec2> hole = {{0.4, 0.4}, {0.4, 0.6}, {0.6, 0.6}, {0.6, 0.4}};
  for (const bool is_turned : {false, true}) {
    PatchBoundary boundary = shapes::rectangle(1, 1, 4, 4);
    shapes::add_polygon(boundary, is_turned ? std::vector<Vec2>(hole.rbegin(), hole.rend()) : hole,
                        {1, 1, 1, 1});
    if (is_turned)
      EXPECT_THROW(constrained_delaunay(boundary), InputError);
    else
      EXPECT_NO_THROW(constrained_delaunay(boundary));
  }
}

TEST(ConstrainedDelaunay, RefusesOutlinesThatAreTurnedInsideOut) {
  // What lies on their left is the pockets between them and their hull, and all beyond it.
  std::vector<Vec2> outline = {{0, 0}, {2, 1}, {4, 0}, {3, 2}, {4, 4}, {2, 3}, {0, 4}, {1, 2}};
  EXPECT_NO_THROW(constrained_delaunay(shapes::polygon(outline)));
  std::ranges::reverse(outline);
  EXPECT_THROW(constrained_delaunay(shapes::polygon(outline)), InputError);
  std::rotate(outline.begin(), outline.begin() + 1, outline.end());
  EXPECT_THROW(constrained_delaunay(shapes::polygon(outline)), InputError);
}

TEST(ConstrainedDelaunay, InvariantsSeeDamage) {
  TriPatch tri = constrained_delaunay(shapes::disk(1, 8));
  std::swap(tri.triangles[0][0], tri.triangles[0][1]);
  EXPECT_FALSE(check_invariants(tri).empty());
}

}  // namespace
}  // namespace delquad
