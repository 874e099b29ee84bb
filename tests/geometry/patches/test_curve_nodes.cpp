// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/patches/curve_nodes.h"
#include "geometry/patches/even_counts.h"
#include "tests/support/meshing.h"

namespace delquad {
namespace {

std::vector<int> totals(const std::vector<CurveDemand>& curves, const std::vector<int>& counts,
                        int n_patches) {
  std::vector<int> total(n_patches, 0);
  for (size_t c = 0; c < curves.size(); ++c) {
    for (const int p : curves[c].patches) total[p] += counts[c];
  }
  return total;
}

// Every curve has two sides, so that a closed set of patches always has an even number of odd ones; an
// outline is free.
TEST(EvenCounts, MakeAllPatchesEven) {
  std::mt19937_64 random(3);
  for (int trial = 0; trial < 400; ++trial) {
    const int n_patches = 1 + static_cast<int>(random() % 5);
    std::vector<CurveDemand> curves(1 + random() % 9);
    for (CurveDemand& curve : curves) {
      curve.integral = 0.2 + 6 * shapes::uniform(random);
      curve.patches.push_back(static_cast<int>(random() % n_patches));
      if (random() % 4) curve.patches.push_back(static_cast<int>(random() % n_patches));
    }
    std::vector<int> odd_patches;
    const auto counts = even_counts(curves, n_patches, *make_primal_dual_solver(), odd_patches);
    const auto total = totals(curves, counts, n_patches);
    EXPECT_TRUE(odd_patches.empty()) << trial;
    for (const int t : total) EXPECT_EQ(t % 2, 0) << trial;
    for (size_t c = 0; c < curves.size(); ++c) {
      EXPECT_GE(counts[c], curves[c].minimum);
      EXPECT_LE(std::abs(counts[c] - std::max(1.0, std::round(curves[c].integral))), 1) << trial;
    }
  }
}

TEST(EvenCounts, ASeamChangesNothing) {
  // Patch 0 has a seam and two outlines of its own.
  const std::vector<CurveDemand> curves = {{3, 1, {0, 0}}, {4, 1, {0}}, {5, 1, {0}}};
  std::vector<int> odd;
  const auto counts = even_counts(curves, 1, *make_primal_dual_solver(), odd);
  EXPECT_EQ(counts[0], 3);
  EXPECT_EQ((counts[1] + counts[2]) % 2, 0);
  EXPECT_TRUE(odd.empty());
}

TEST(EvenCounts, EdgesKeepTheirLeastLengthIfTheyCan) {
  std::mt19937_64 random(4);
  for (int trial = 0; trial < 100; ++trial) {
    std::vector<CurveDemand> curves;
    for (int c = 0; c < 4; ++c) {
      const double integral = 1.2 + 3 * shapes::uniform(random);
      curves.push_back({integral, 1, {0}, 0, most_edges(integral, 0.95)});
    }
    std::vector<int> odd;
    const auto counts = even_counts(curves, 1, *make_primal_dual_solver(), odd);
    EXPECT_EQ(totals(curves, counts, 1)[0] % 2, 0);
    for (std::size_t c = 0; c < curves.size(); ++c) EXPECT_LE(counts[c], curves[c].most) << trial;
  }
}

/// Curves where three patches meet, as at a rib: they alone can make groups of patches even that share no
/// other curve.
TEST(EvenCounts, BranchingCurvesTakePart) {
  std::mt19937_64 random(5);
  int helped = 0;
  for (int trial = 0; trial < 300; ++trial) {
    std::vector<CurveDemand> curves;
    const int n_patches = 3 + static_cast<int>(random() % 4);
    for (int c = 0; c < 2 * n_patches; ++c) {
      CurveDemand curve{1.5 + 6 * shapes::uniform(random), 1, {}};
      const int first = static_cast<int>(random() % n_patches);
      for (int k = 0; k < 3; ++k) curve.patches.push_back((first + k) % n_patches);
      curves.push_back(curve);
    }
    std::vector<int> odd_patches;
    const auto counts = even_counts(curves, n_patches, *make_primal_dual_solver(), odd_patches);
    const auto total = totals(curves, counts, n_patches);
    for (int p = 0; p < n_patches; ++p)
      EXPECT_EQ(total[p] % 2 != 0, std::ranges::count(odd_patches, p) > 0) << trial;
    helped += odd_patches.empty();
    for (size_t c = 0; c < curves.size(); ++c)
      EXPECT_LE(std::abs(counts[c] - std::max(1.0, std::round(curves[c].integral))), 1) << trial;
  }
  EXPECT_GT(helped, 100);
}

TEST(CurveChains, ClosedCurvesBeginAtTheirCorners) {
  SurfaceModel model;
  for (int i = 0; i < 6; ++i) model.fine.points.push_back({std::cos(i * 1.0), std::sin(i * 1.0), 0});
  for (int i = 0; i < 6; ++i) {
    model.fine.lines.push_back({i, (i + 1) % 6});
    model.fine.line_curve.push_back(0);
  }
  model.fine.curves.push_back({1, {}});
  EXPECT_EQ(curve_chains(model).size(), 1u);
  model.corners = {2};
  EXPECT_EQ(curve_chains(model)[0].points, (std::vector<int>{2, 3, 4, 5, 0, 1, 2}));
  model.corners = {2, 4};
  const auto chains = curve_chains(model);
  ASSERT_EQ(chains.size(), 2u);
  EXPECT_EQ(chains[0].points, (std::vector<int>{2, 3, 4}));
  EXPECT_EQ(chains[1].points, (std::vector<int>{4, 5, 0, 1, 2}));
  EXPECT_EQ(chains[1].curve, 0);
}

TEST(PlaceNodes, AtEqualIntegrals) {
  SurfaceModel model;
  model.fine.points = {{0, 0, 0}, {1, 0, 0}, {4, 0, 0}};
  model.fine.lines = {{0, 1}, {1, 2}};
  model.fine.line_curve = {0, 0};
  model.fine.curves.push_back({1, {}});
  const auto chains = curve_chains(model);
  const std::vector<SizeIntegral> integrals = {
      size_integral(model.fine, chains[0], [](int, int, double, const Vec3&, int&) { return 0.5; })};
  EXPECT_NEAR(integrals[0].total(), 8, 1e-12);
  const SurfaceNodes nodes = place_nodes(model, chains, {-1}, integrals, equal_places({4}));
  ASSERT_EQ(nodes.points.size(), 5u);
  for (int k = 0; k <= 4; ++k) EXPECT_NEAR(nodes.points[nodes.on_curve[0][k].node].x, k, 1e-12);
}

}  // namespace
}  // namespace delquad
