#include "smoothing/space_lift.h"

#include <gtest/gtest.h>

#include <cmath>

#include "metrics/metrics.h"
#include "tests/support/quad_patches.h"

namespace delquad {
namespace {

using testing_support::grid_patch;

/// Bent steeply: quads that are square in the plane are not in space.
Vec3 bent(Vec2 u, int&) { return {u.x, u.y + 0.8 * u.x, 0.3 * u.x * u.x}; }

double worst_in_space(const QuadPatch& patch) {
  double worst = 1;
  int hint = -1;
  for (const auto& q : patch.quads) {
    Vec3 x[4];
    for (int k = 0; k < 4; ++k) x[k] = bent(patch.points[q[k]], hint);
    worst = std::min(worst, quad_eta(x[0], x[1], x[2], x[3], cross(x[2] - x[0], x[3] - x[1])));
  }
  return worst;
}

std::vector<Vec3> boundary_of(const QuadPatch& patch) {
  std::vector<Vec3> places;
  int hint = -1;
  for (int v = 0; v < patch.n_boundary; ++v) places.push_back(bent(patch.points[v], hint));
  return places;
}

TEST(SpaceLift, BadQuadsGetBetterAndNoneGetsWorse) {
  for (int seed = 0; seed < 10; ++seed) {
    QuadPatch patch = testing_support::jittered(grid_patch(5, 4), seed, 0.45);
    const QuadPatch start = patch;
    const double before = worst_in_space(patch);
    const std::vector<Vec3> inside = lift_worst_in_space(patch, boundary_of(patch), bent, 0.5, 20);
    int hint = -1;
    for (std::size_t i = 0; i < inside.size(); ++i)
      EXPECT_EQ(inside[i], bent(patch.points[patch.n_boundary + i], hint));
    EXPECT_GT(worst_in_space(patch), std::max(before, 0.2)) << seed;
    EXPECT_EQ(patch.quads, start.quads);
    for (int v = 0; v < patch.n_boundary; ++v) EXPECT_EQ(patch.points[v], start.points[v]);
  }
}

TEST(SpaceLift, WhatIsGoodStays) {
  QuadPatch patch = grid_patch(4, 4);
  const QuadPatch start = patch;
  lift_worst_in_space(patch, boundary_of(patch), bent, 0.1, 20);
  EXPECT_EQ(patch.points, start.points);
}

}  // namespace
}  // namespace delquad
