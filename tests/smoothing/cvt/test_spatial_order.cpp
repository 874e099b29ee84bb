// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/cvt/moving_delaunay.h"
#include "tests/smoothing/seeds.h"

namespace delquad {
namespace {

TriPatch random_patch() {
  const PatchBoundary boundary = shapes::annulus(0.4, 1, 40, 100);
  return constrained_delaunay(boundary, random_seeds(boundary, 3, 3000, 0.03));
}

double length_of_way(const std::vector<Vec2>& points, int first) {
  double sum = 0;
  for (std::size_t i = first + 1; i < points.size(); ++i) sum += norm(points[i] - points[i - 1]);
  return sum;
}

TEST(SpatialOrders, BringNeighboursTogether) {
  const TriPatch patch = random_patch();
  const TriPatch ordered = reordered(patch, spatial_order(patch));
  EXPECT_LT(length_of_way(ordered.points, patch.n_boundary),
            0.1 * length_of_way(patch.points, patch.n_boundary));
}

TEST(SpatialOrders, KeepTheTriangulation) {
  const TriPatch patch = random_patch();
  const std::vector<int> order = spatial_order(patch);
  std::vector<int> sorted = order;
  std::ranges::sort(sorted);
  ASSERT_EQ(sorted.size(), patch.points.size() - patch.n_boundary);
  for (std::size_t k = 0; k < sorted.size(); ++k)
    EXPECT_EQ(sorted[k], patch.n_boundary + static_cast<int>(k));

  const TriPatch ordered = reordered(patch, order);
  EXPECT_EQ(ordered.n_boundary, patch.n_boundary);
  EXPECT_TRUE(
      std::equal(ordered.points.begin(), ordered.points.begin() + patch.n_boundary, patch.points.begin()));
  EXPECT_TRUE(check_invariants(ordered).empty());
  const auto corners = [](const TriPatch& tri) {
    std::vector<std::array<Vec2, 3>> all;
    for (const auto& v : tri.triangles) all.push_back({tri.points[v[0]], tri.points[v[1]], tri.points[v[2]]});
    std::ranges::sort(all, {}, [](const std::array<Vec2, 3>& a) {
      return std::array{a[0].x, a[0].y, a[1].x, a[1].y, a[2].x, a[2].y};
    });
    return all;
  };
  EXPECT_EQ(corners(ordered), corners(patch));
}

TEST(SpatialOrders, OfNoInnerPoints) {
  const TriPatch patch = constrained_delaunay(shapes::rectangle(1, 1, 2, 2));
  EXPECT_TRUE(spatial_order(patch).empty());
  EXPECT_TRUE(check_invariants(reordered(patch, {})).empty());
}

}  // namespace
}  // namespace delquad
