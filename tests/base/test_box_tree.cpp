// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/box_tree.h"
#include "geometry/mesh/nearest_triangle.h"
#include "tests/support/meshing.h"

namespace delquad {
namespace {

class Random {
 public:
  double number() { return std::uniform_real_distribution<double>(-1, 1)(engine_); }
  Vec3 point() { return {number(), number(), number()}; }
  int below(int n) { return static_cast<int>(engine_() % static_cast<unsigned>(n)); }

 private:
  std::mt19937 engine_{3};
};

TEST(Box, HoldsItsPointsAndNoMore) {
  const std::vector<Vec2> points = {{1, 5}, {-2, 3}, {0, 4}};
  const auto box = Box<Vec2>::around(std::span(points));
  EXPECT_EQ(box.low, (Vec2{-2, 3}));
  EXPECT_EQ(box.size(), (Vec2{3, 2}));
  EXPECT_DOUBLE_EQ(diagonal(points), std::sqrt(13.0));
  EXPECT_EQ(diagonal(std::vector<Vec3>{}), 0);
}

TEST(BoxTree, WithoutItemsNothingIsVisited) {
  BoxTree<Vec2>().nearest({0, 0}, 1.0, [](int) { FAIL(); });
  BoxTree<Vec3>(std::vector<Box<Vec3>>{}).nearest({0, 0, 0}, 1.0, [](int) { FAIL(); });
}

TEST(BoxTree, EveryItemIsVisitedOnceWithoutALimit) {
  Random random;
  std::vector<Box<Vec3>> boxes;
  for (int i = 0; i < 1000; ++i) boxes.push_back(Box<Vec3>::around({random.point(), random.point()}));
  std::vector<int> visits(boxes.size(), 0);
  BoxTree<Vec3>(boxes).nearest({0, 0, 0}, 1e9, [&](int i) { ++visits[i]; });
  EXPECT_EQ(visits, std::vector<int>(boxes.size(), 1));
}

TEST(BoxTree, NothingWithinTheLimitIsMissed) {
  Random random;
  std::vector<Box<Vec2>> boxes;
  for (int i = 0; i < 500; ++i) {
    const Vec2 p{random.number(), random.number()};
    boxes.push_back({p, p + Vec2{0.02, 0.01}});
  }
  const BoxTree<Vec2> tree(boxes);
  for (int trial = 0; trial < 100; ++trial) {
    const Vec2 x{random.number(), random.number()};
    std::vector<char> visited(boxes.size(), 0);
    int n_visited = 0;
    tree.nearest(x, 0.01, [&](int i) { visited[i] = 1, ++n_visited; });
    for (std::size_t i = 0; i < boxes.size(); ++i) EXPECT_TRUE(visited[i] || boxes[i].distance2(x) > 0.01);
    EXPECT_LT(n_visited, 250) << "the tree cuts off what is far";
  }
}

TEST(NearestTriangle, AgreesWithLookingAtAll) {
  Random random;
  std::vector<Vec3> points;
  for (int i = 0; i < 200; ++i) points.push_back(random.point());
  points.push_back(points[0]);  // flat triangles
  std::vector<std::array<int, 3>> triangles;
  for (int t = 0; t < 400; ++t)
    triangles.push_back({random.below(201), random.below(201), random.below(201)});
  const NearestTriangle nearest(points, triangles);
  for (int trial = 0; trial < 300; ++trial) {
    const Vec3 x = 1.5 * random.point();
    double least = 1e9;
    for (const auto& [a, b, c] : triangles) {
      const auto w = nearest_weights(points[a], points[b], points[c], x);
      least = std::min(least, norm(w[0] * points[a] + w[1] * points[b] + w[2] * points[c] - x));
    }
    const auto found = nearest.find(x);
    EXPECT_NEAR(found.distance, least, 1e-14);
    EXPECT_EQ(nearest.find(x, 0.99 * least).triangle, -1);
    EXPECT_EQ(nearest.find(x, 1.01 * least).triangle, found.triangle);
  }
}

// Slivers that cross each other's boxes.
TEST(NearestTriangle, AgreesWithLookingAtAllSlivers) {
  Random random;
  std::vector<Vec3> points;
  std::vector<std::array<int, 3>> triangles;
  for (int t = 0; t < 200; ++t) {
    const Vec3 a = random.point(), b = random.point(), tip = 1e-4 * random.point();
    const int first = static_cast<int>(points.size());
    points.insert(points.end(), {a, 0.3 * a + 0.7 * b + tip, b});
    triangles.push_back({first + t % 3, first + (t + 1) % 3, first + (t + 2) % 3});
  }
  const NearestTriangle nearest(points, triangles);
  for (int trial = 0; trial < 300; ++trial) {
    const Vec3 x = trial % 2 == 0 ? 1.5 * random.point() : points[random.below(600)];
    double least = 1e9;
    for (const auto& [a, b, c] : triangles) {
      const auto w = nearest_weights(points[a], points[b], points[c], x);
      least = std::min(least, norm(w[0] * points[a] + w[1] * points[b] + w[2] * points[c] - x));
    }
    EXPECT_NEAR(nearest.find(x).distance, least, 1e-14);
  }
}

TEST(NearestTriangle, TheFirstOfSeveral) {
  const NearestTriangle nearest({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}},
                                {{0, 1, 2}, {0, 3, 1}, {0, 1, 2}});
  EXPECT_EQ(nearest.find({0.5, 0, 1}).triangle, 0);
  EXPECT_EQ(nearest.find({0.5, -0.1, 1}).triangle, 1);
}

}  // namespace
}  // namespace delquad
