// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/cvt/moving_delaunay.h"
#include "tests/smoothing/seeds.h"

namespace delquad {
namespace {

/// Corners start at a triangle of their point, and boundary fans begin with a boundary side.
void expect_sound(const MovingDelaunay& d) {
  const TriPatch& tri = d.patch();
  EXPECT_TRUE(check_invariants(tri).empty());
  std::vector<int> corners(tri.points.size(), 0);
  for (const auto& v : tri.triangles)
    for (const int i : v) ++corners[i];
  for (int i = 0; i < d.n_points(); ++i) {
    int seen = 0;
    for_each_corner(d, i, [&](int t, int k) {
      EXPECT_EQ(tri.triangles[t][k], i);
      ++seen;
    });
    EXPECT_EQ(seen, corners[i]) << i;
    const int t = d.corners(i).front() / 3, k = d.corners(i).front() % 3;
    if (i < d.n_boundary()) {
      EXPECT_EQ(tri.neighbours[t][(k + 2) % 3], -1) << i;
    }
  }
  for (std::size_t t = 0; t < tri.triangles.size(); ++t)
    for (const int u : tri.neighbours[t]) {
      if (u < 0) continue;
      const auto& v = tri.triangles[t];
      for (const int w : tri.triangles[u])
        EXPECT_LE(in_circle_filtered(tri.points[v[0]], tri.points[v[1]], tri.points[v[2]], tri.points[w]), 0);
    }
}

std::set<std::array<int, 3>> sorted_triangles(const TriPatch& tri) {
  std::set<std::array<int, 3>> result;
  for (auto v : tri.triangles) {
    std::sort(v.begin(), v.end());
    result.insert(v);
  }
  return result;
}

TEST(MovingDelaunays, FollowSmallMovesByFlips) {
  for (const std::uint64_t seed : {1, 2, 3, 4, 5}) {
    const PatchBoundary boundary = shapes::random_polygon_with_holes(seed, 0.1);
    const std::vector<Vec2> seeds = random_seeds(boundary, seed, 400, 0.05);
    MovingDelaunay delaunay(constrained_delaunay(boundary, seeds));
    std::mt19937_64 random(seed);
    std::vector<Vec2> moved = seeds;
    for (int step = 0; step < 5; ++step) {
      for (Vec2& x : moved) x += 0.004 * Vec2{shapes::uniform(random) - 0.5, shapes::uniform(random) - 0.5};
      ASSERT_TRUE(delaunay.move_to(moved));
      expect_sound(delaunay);
      EXPECT_EQ(sorted_triangles(delaunay.patch()), sorted_triangles(constrained_delaunay(boundary, moved)));
      EXPECT_EQ(inner_points(delaunay.patch()), moved);
    }
    EXPECT_EQ(delaunay.rebuilds(), 0);
    EXPECT_GT(delaunay.flips(), 0);
  }
}

TEST(MovingDelaunays, AreMadeAnewWherePointsChangePlaces) {
  const PatchBoundary boundary = shapes::annulus(0.4, 1, 24, 60);
  const std::vector<Vec2> seeds = random_seeds(boundary, 7, 500, 0.08);
  MovingDelaunay delaunay(constrained_delaunay(boundary, seeds));
  std::vector<Vec2> moved = seeds;
  std::reverse(moved.begin(), moved.end());
  ASSERT_TRUE(delaunay.move_to(moved));
  EXPECT_EQ(delaunay.rebuilds(), 1);
  expect_sound(delaunay);
  EXPECT_EQ(sorted_triangles(delaunay.patch()), sorted_triangles(constrained_delaunay(boundary, moved)));
}

TEST(MovingDelaunays, RefusePlacesWhereNoPointMayBe) {
  const PatchBoundary boundary = shapes::annulus(0.4, 1, 24, 60);
  const std::vector<Vec2> seeds = random_seeds(boundary, 7, 500, 0.08);
  for (const Vec2 bad : {Vec2{2, 0}, Vec2{0.01, 0.02}, boundary.points[3], seeds[5], Vec2{NAN, 0},
                         0.5 * (boundary.points[0] + boundary.points[1])}) {
    MovingDelaunay delaunay(constrained_delaunay(boundary, seeds));
    std::vector<Vec2> moved = seeds;
    moved[0] = bad;
    EXPECT_FALSE(delaunay.move_to(moved)) << bad.x << " " << bad.y;
    ASSERT_TRUE(delaunay.move_to(seeds));  // and can be used further
    expect_sound(delaunay);
  }
}

TEST(MovingDelaunays, RefuseInvertedTriangles) {
  TriPatch tri = constrained_delaunay(shapes::rectangle(1, 1, 4, 4), {{0.4, 0.5}, {0.7, 0.6}});
  tri.points.back() = {2, 2};
  expect_input_error([&] { MovingDelaunay delaunay(tri); }, {"flat or inverted", "points"});
}

TEST(MovingDelaunays, KeepPointsThatDoNotMove) {
  const PatchBoundary boundary = shapes::rectangle(1, 1, 2, 2);
  MovingDelaunay delaunay(constrained_delaunay(boundary));
  EXPECT_TRUE(delaunay.move_to({}));
  expect_sound(delaunay);
}

}  // namespace
}  // namespace delquad
