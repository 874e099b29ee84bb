// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/matching/edge_counts.h"
#include "tests/support/meshing.h"

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
      const double ideal = 1 + static_cast<double>(random() % 1000) / 60;
      curves.push_back({ideal, std::max(1, static_cast<int>(std::lround(ideal))), 1, true});
    }
    std::vector<CountedFace> faces;
    for (int j = 0; j < grid.ny; ++j)
      for (int i = 0; i < grid.nx; ++i) {
        CountedFace face;
        face.n_sides = random() % 2 == 0 ? 4 : 0;
        const std::array<int, 4> around{grid.below(i, j), grid.left(i + 1, j), grid.below(i, j + 1),
                                        grid.left(i, j)};
        for (int k = 0; k < 4; ++k) face.sides[face.n_sides == 4 ? k : 0].push_back(around[k]);
        faces.push_back(face);
      }
    ASSERT_TRUE(balance_counts(curves, faces).empty());
    for (const CountedFace& face : faces) {
      if (face.n_sides == 4) {
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
  CountedFace face{{std::vector{0, 1}, {3}, {2}, {4}}, 4};
  ASSERT_TRUE(balance_counts(curves, {face}).empty());
  EXPECT_EQ(curves[0].n + curves[1].n, curves[2].n);
  EXPECT_EQ(curves[4].n, 5);
}

/// Four blocks in a square, or a triangle beside two blocks, with few edges each.
struct SmallNetwork {
  std::vector<CountedCurve> curves;
  std::vector<CountedFace> faces;
};

SmallNetwork random_network(std::mt19937& random) {
  SmallNetwork net;
  const FaceGrid grid{2, 1 + static_cast<int>(random() % 2)};
  for (int c = 0; c < grid.n_curves(); ++c) {
    const double ideal = 1 + static_cast<double>(random() % 1000) / 250;
    net.curves.push_back({ideal, std::max(1, static_cast<int>(std::lround(ideal))), 1, true});
  }
  for (int j = 0; j < grid.ny; ++j)
    for (int i = 0; i < grid.nx; ++i) {
      CountedFace face;
      face.n_sides = random() % 4 == 0 ? 0 : 4;
      const std::array<int, 4> around{grid.below(i, j), grid.left(i + 1, j), grid.below(i, j + 1),
                                      grid.left(i, j)};
      for (int k = 0; k < 4; ++k) face.sides[face.n_sides == 4 ? k : 0].push_back(around[k]);
      net.faces.push_back(face);
    }
  if (grid.ny == 1 && random() % 2 == 0) {
    const int first = grid.n_curves();
    for (int k = 0; k < 2; ++k) net.curves.push_back({3, 3, 1, true});
    net.faces.push_back({{std::vector{grid.below(0, 0)}, {first}, {first + 1}, {}}, 3});
  }
  return net;
}

bool holds(const SmallNetwork& net) {
  return std::ranges::all_of(net.faces, [&](const CountedFace& face) {
    const auto [a, b] = imbalance(face, net.curves);
    if (face.n_sides == 4) return a == 0 && b == 0;
    int n[3] = {0, 0, 0};
    for (int k = 0; k < 3; ++k)
      for (const int c : face.sides[k]) n[k] += net.curves[c].n;
    const int sum = n[0] + n[1] + n[2];
    return sum % 2 == 0 && (face.n_sides == 0 || 2 * std::max({n[0], n[1], n[2]}) < sum);
  });
}

double cost(const SmallNetwork& net) {
  double sum = 0;
  for (const CountedCurve& c : net.curves) sum += std::pow(std::log(c.n / c.ideal), 2);
  return sum;
}

/// The least cost of all numbers of edges up to six.
double least_cost(SmallNetwork net) {
  double least = 1e300;
  for (CountedCurve& c : net.curves) c.n = 1;
  for (;;) {
    if (holds(net)) least = std::min(least, cost(net));
    std::size_t k = 0;
    while (k < net.curves.size() && ++net.curves[k].n > 6) net.curves[k++].n = 1;
    if (k == net.curves.size()) return least;
  }
}

TEST(SideCounts, NearlyTheLeastSumOfAll) {
  std::mt19937 random(7);
  int least = 0, all = 0;
  for (int round = 0; round < 200; ++round) {
    SmallNetwork net = random_network(random);
    if (net.curves.size() > 7) continue;
    const double best = least_cost(net);
    ASSERT_TRUE(balance_counts(net.curves, net.faces).empty());
    ASSERT_TRUE(holds(net));
    ++all;
    least += cost(net) < best + 1e-9;
    EXPECT_LT(cost(net), 1.5 * best + 0.1);
  }
  EXPECT_GT(all, 20);
  EXPECT_GT(least, 0.9 * all) << least << " of " << all;
}

TEST(SideCounts, SidesOfAThreeSidedFace) {
  // The long side gives way, and the parity is repaired.
  std::vector<CountedCurve> curves{{20, 20, 1, true}, {5, 5, 1, true}, {6, 6, 1, true}};
  CountedFace face{{std::vector{0}, {1}, {2}, {}}, 3};
  ASSERT_TRUE(balance_counts(curves, {face}).empty());
  EXPECT_LT(curves[0].n, curves[1].n + curves[2].n);
  EXPECT_EQ((curves[0].n + curves[1].n + curves[2].n) % 2, 0);
  curves = {{20, 20, 1, false}, {5, 5, 1, false}, {6, 6, 1, true}};
  ASSERT_TRUE(balance_counts(curves, {face}).empty());
  EXPECT_EQ(curves[2].n, 17);
  curves = {{20, 20, 1, false}, {5, 5, 1, false}, {7, 7, 1, false}};
  const auto bad = balance_counts(curves, {face});
  ASSERT_EQ(bad.size(), 1u);
  EXPECT_EQ(bad[0].fixed, (std::vector{0, 1, 2}));
}

TEST(SideCounts, AChainOfTenWantsTheirMean) {
  // One of eleven curves wants twice as many edges: the geometric mean of all is the least sum of squares.
  std::vector<CountedCurve> curves;
  for (int i = 0; i <= 10; ++i) curves.push_back({i == 0 ? 40.0 : 20.0, i == 0 ? 40 : 20, 1, true});
  std::vector<CountedFace> faces;
  for (int i = 0; i < 10; ++i) {
    const int side = static_cast<int>(curves.size());
    curves.push_back({5, 5, 1, true});
    curves.push_back({5, 5, 1, true});
    faces.push_back({{std::vector{i}, {side}, {i + 1}, {side + 1}}, 4});
  }
  ASSERT_TRUE(balance_counts(curves, faces).empty());
  for (int i = 0; i <= 10; ++i) EXPECT_EQ(curves[i].n, 21);  // 20 * 2^(1/11) = 21.3
}

TEST(SideCounts, WhatCannotBeIsSaid) {
  std::vector<CountedCurve> curves{{3, 3, 1, false}, {4, 4, 1, false}, {2, 2, 1, true}, {2, 2, 1, true}};
  const CountedFace mapped{{std::vector{0}, {2}, {1}, {3}}, 4};
  const auto bad = balance_counts(curves, {mapped});
  ASSERT_EQ(bad.size(), 1u);
  EXPECT_EQ(bad[0].face, 0);
  EXPECT_EQ(bad[0].fixed, (std::vector{0, 1}));
  const CountedFace free{{std::vector{0, 1}, {}, {}, {}}, 0};
  EXPECT_EQ(balance_counts(curves, {free}).at(0).face, 0);
  // The only other way around the odd face leads back to it.
  std::vector<CountedCurve> ring{
      {3, 3, 1, true}, {3, 3, 1, true}, {4, 4, 1, false}, {4, 4, 1, false}, {5, 5, 1, false}};
  const CountedFace strip{{std::vector{0}, {2}, {1}, {3}}, 4};
  const CountedFace around{{std::vector{0, 1, 4}, {}, {}, {}}, 0};
  EXPECT_EQ(balance_counts(ring, {strip, around}).at(0).face, 1);
}

}  // namespace
}  // namespace delquad
