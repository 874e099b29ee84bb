#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "matching/side_counts.h"

namespace delquad {
namespace {

/// Cells of a grid of faces: curve (i, j, 0) lies below cell (i, j), (i, j, 1) on its left.
struct FaceGrid {
  int nx, ny;
  int below(int i, int j) const { return j * nx + i; }
  int left(int i, int j) const { return nx * (ny + 1) + j * (nx + 1) + i; }
  int n_curves() const { return nx * (ny + 1) + (nx + 1) * ny; }
};

std::array<int, 2> imbalance(const CountedFace& face, const std::vector<CountedCurve>& curves) {
  std::array<int, 4> sums{};
  for (int k = 0; k < 4; ++k)
    for (const int c : face.sides[k]) sums[k] += curves[c].n;
  return {sums[0] - sums[2], sums[1] - sums[3]};
}

TEST(SideCounts, RandomGridsOfMappedAndFreeFaces) {
  std::mt19937 random(3);
  for (int round = 0; round < 200; ++round) {
    const FaceGrid grid{1 + static_cast<int>(random() % 5), 1 + static_cast<int>(random() % 4)};
    std::vector<CountedCurve> curves;
    for (int c = 0; c < grid.n_curves(); ++c) {
      const double want = 1 + static_cast<double>(random() % 1000) / 60;
      curves.push_back({want, std::max(1, static_cast<int>(std::lround(want))), 1, true});
    }
    std::vector<CountedFace> faces;
    for (int j = 0; j < grid.ny; ++j)
      for (int i = 0; i < grid.nx; ++i) {
        CountedFace face;
        face.is_mapped = random() % 2 == 0;
        const std::array<int, 4> around{grid.below(i, j), grid.left(i + 1, j), grid.below(i, j + 1),
                                        grid.left(i, j)};
        for (int k = 0; k < 4; ++k) face.sides[face.is_mapped ? k : 0].push_back(around[k]);
        faces.push_back(face);
      }
    ASSERT_EQ(balance_counts(curves, faces), std::nullopt);
    for (const CountedFace& face : faces) {
      if (face.is_mapped) {
        EXPECT_EQ(imbalance(face, curves), (std::array{0, 0}));
      } else {
        EXPECT_EQ(imbalance(face, curves)[0] % 2, 0);
      }
    }
    for (const CountedCurve& c : curves) EXPECT_GE(c.n, c.least);
  }
}

TEST(SideCounts, SidesOfSeveralCurves) {
  // Two short curves face a long one.
  std::vector<CountedCurve> curves{
      {3, 3, 1, true}, {4, 4, 1, true}, {10, 10, 1, true}, {5, 5, 1, false}, {6, 6, 1, true}};
  CountedFace face{{std::vector{0, 1}, {3}, {2}, {4}}, true};
  ASSERT_EQ(balance_counts(curves, {face}), std::nullopt);
  EXPECT_EQ(curves[0].n + curves[1].n, curves[2].n);
  EXPECT_EQ(curves[4].n, 5);
}

TEST(SideCounts, WhatCannotBeIsSaid) {
  std::vector<CountedCurve> curves{{3, 3, 1, false}, {4, 4, 1, false}, {2, 2, 1, true}, {2, 2, 1, true}};
  const CountedFace mapped{{std::vector{0}, {2}, {1}, {3}}, true};
  EXPECT_EQ(balance_counts(curves, {mapped}), 0);
  const CountedFace free{{std::vector{0, 1}, {}, {}, {}}, false};
  EXPECT_EQ(balance_counts(curves, {free}), 0);
  // The only other way around the odd face leads back to it.
  std::vector<CountedCurve> ring{
      {3, 3, 1, true}, {3, 3, 1, true}, {4, 4, 1, false}, {4, 4, 1, false}, {5, 5, 1, false}};
  const CountedFace strip{{std::vector{0}, {2}, {1}, {3}}, true};
  const CountedFace around{{std::vector{0, 1, 4}, {}, {}, {}}, false};
  EXPECT_EQ(balance_counts(ring, {strip, around}), 1);
}

}  // namespace
}  // namespace delquad
