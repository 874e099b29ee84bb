// SPDX-License-Identifier: GPL-3.0-or-later
#include "algorithms/recombination/dual_graph.h"
#include "tests/algorithms/stages.h"
#include "tests/support/tri_patches.h"

namespace delquad {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kRounding = 1e-12;

TEST(SignedEta, ClosedForms) {
  EXPECT_NEAR(signed_eta({0, 0}, {3, 0}, {3, 1}, {0, 1}), 1, kRounding);
  // Rhombus of two equilateral triangles: 60 and 120 degrees.
  const double h = std::sqrt(3) / 2;
  EXPECT_NEAR(signed_eta({0, 0}, {1, 0}, {1.5, h}, {0.5, h}), 2.0 / 3, kRounding);
  EXPECT_NEAR(signed_eta({0, 0}, {1, 0}, {2, 0}, {1, 1}), 0, kRounding);   // flat corner
  EXPECT_NEAR(signed_eta({0, 0}, {1, 1}, {2, 0}, {1, 3}), -1, kRounding);  // 270 degrees at (1, 1)
  EXPECT_NEAR(signed_eta({0, 1}, {3, 1}, {3, 0}, {0, 0}), -1, kRounding);  // turned over: four times 270
  EXPECT_LE(signed_eta({1, 1}, {1, 1}, {2, 0}, {3, 3}), 0);                // a side of no length
  EXPECT_NEAR(signed_eta({0, 0}, {1e-120, 0}, {1e-120, 1e-120}, {0, 1e-120}), 1, kRounding);
}

TEST(SignedEta, IsTheSameFromEveryCornerAndFallsAsACornerTurnsReflex) {
  double before = 1;
  for (double y = -1.0; y < 0.99; y += 0.05) {
    const double eta = signed_eta({0, y}, {2, 0}, {0, 1}, {-2, 0});  // the angle at (0, y) grows
    EXPECT_NEAR(eta, signed_eta({0, 1}, {-2, 0}, {0, y}, {2, 0}), kRounding);
    EXPECT_NEAR(eta, signed_eta({2, 0}, {0, 1}, {-2, 0}, {0, y}), kRounding);
    EXPECT_LT(eta, before) << y;
    before = eta;
  }
  EXPECT_LT(before, -0.5);
}

TEST(Hilbert, VisitsTheCellsOfALatticeSideBySide) {
  for (const int side : {64, 512}) {
    std::vector<Vec2> points;
    for (int i = 0; i < side; ++i) {
      for (int j = 0; j < side; ++j) points.push_back({double(i), double(j)});
    }
    const std::vector<int> order = hilbert_order(points);
    ASSERT_EQ(order.size(), points.size());
    EXPECT_EQ(std::set<int>(order.begin(), order.end()).size(), points.size());
    for (std::size_t k = 1; k < order.size(); ++k) {
      const Vec2 d = points[order[k]] - points[order[k - 1]];
      ASSERT_EQ(std::abs(d.x) + std::abs(d.y), 1) << k;
    }
  }
}

TEST(Hilbert, CoincidentPointsKeepTheirOrder) {
  EXPECT_EQ(hilbert_order(std::vector<Vec2>(4, Vec2{2, 3})), (std::vector<int>{0, 1, 2, 3}));
  EXPECT_TRUE(hilbert_order({}).empty());
}

TEST(DualGraph, CostsAreMillionthsOfOneMinusEta) {
  const TriPatch square = make_patch({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, {{0, 1, 2}, {0, 2, 3}}, 4);
  const DualGraph dual = build_dual_graph(square);
  ASSERT_EQ(dual.graph.edges.size(), 1u);
  EXPECT_EQ(dual.graph.edges[0].cost, 0);
  EXPECT_TRUE(dual.extra_vertex.empty());

  // 60 and 120 degrees: a third; 20 degrees beyond a flat corner: 1 + 20/90.
  const double h = std::sqrt(3) / 2;
  const TriPatch rhombus = make_patch({{0, 0}, {1, 0}, {1.5, h}, {0.5, h}}, {{0, 1, 3}, {1, 2, 3}}, 4);
  EXPECT_NEAR(double(build_dual_graph(rhombus).graph.edges[0].cost), kCostUnit / 3.0, 1);
  const double y = std::tan(10 * kPi / 180);
  const TriPatch dart = make_patch({{0, y}, {1, 0}, {0, 2}, {-1, 0}}, {{0, 1, 2}, {0, 2, 3}}, 4);
  EXPECT_NEAR(double(build_dual_graph(dart).graph.edges[0].cost), kCostUnit * (1 + 20.0 / 90), 1);
}

/// The fan of k triangles at point 0 of a half disk of k + 2 boundary points.
TriPatch half_disk_fan(int k) {
  std::vector<Vec2> points = {{0, 0}};
  std::vector<std::array<int, 3>> triangles;
  for (int i = 0; i <= k; ++i) points.push_back({std::cos(kPi * i / k), std::sin(kPi * i / k)});
  for (int i = 1; i <= k; ++i) triangles.push_back({0, i, i + 1});
  return make_patch(points, triangles, k + 2);
}

TEST(DualGraph, ExtraEdgesJoinTheEndsOfFansOfThreeAndMore) {
  EXPECT_TRUE(build_dual_graph(half_disk_fan(1)).extra_vertex.empty());
  EXPECT_TRUE(build_dual_graph(half_disk_fan(2)).extra_vertex.empty());
  for (const int k : {3, 4, 7}) {
    const DualGraph dual = build_dual_graph(half_disk_fan(k));
    ASSERT_EQ(dual.extra_vertex, std::vector<int>{0}) << k;
    const MatchingGraph::Edge& extra = dual.graph.edges[dual.first_extra];
    const std::set<int> ends = {dual.triangle[extra.a], dual.triangle[extra.b]};
    EXPECT_EQ(ends, (std::set<int>{0, k - 1}));
    EXPECT_EQ(extra.cost, kExtraEdgeCost);
    EXPECT_EQ(dual.first_extra, k - 1);
    // An odd fan has a spare that every triangle may take.
    EXPECT_EQ(dual.graph.n_nodes, k + k % 2);
    EXPECT_EQ(static_cast<int>(dual.graph.edges.size()), dual.first_extra + 1 + (k % 2) * k);
  }
}

TEST(DualGraph, HolesHaveExtraEdgesTooAndNoTwoEdgesAreParallel) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    const PatchBoundary boundary = shapes::random_polygon_with_holes(seed, seed % 2 == 0 ? 0 : 0.2);
    const TriPatch tri = constrained_delaunay(boundary, random_inner_points(boundary, seed, 60, 0.1));
    const DualGraph dual = build_dual_graph(tri);
    std::vector<int> fan(boundary.points.size(), 0);
    for (const auto& t : tri.triangles) {
      for (const int v : t) {
        if (v < tri.n_boundary) ++fan[v];
      }
    }
    std::vector<int> expected;
    for (int b = 0; b < tri.n_boundary; ++b) {
      if (fan[b] >= 3) expected.push_back(b);
    }
    EXPECT_EQ(dual.extra_vertex, expected) << seed;
    std::set<std::pair<int, int>> seen;
    for (const auto& e : dual.graph.edges) {
      EXPECT_NE(e.a, e.b);
      EXPECT_TRUE(seen.emplace(std::min(e.a, e.b), std::max(e.a, e.b)).second) << seed;
    }
  }
}

TEST(SplitSpanningSides, LeavesNoneAndKeepsTheMeshSound) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    const PatchBoundary boundary = shapes::random_polygon_with_holes(seed, seed % 2 == 0 ? 0 : 0.3);
    TriPatch tri = constrained_delaunay(boundary);
    const std::size_t before = tri.triangles.size();
    const int cuts = split_spanning_sides(tri);
    EXPECT_GT(cuts, 0);
    EXPECT_EQ(tri.triangles.size(), before + 2 * cuts);
    EXPECT_EQ(tri.points.size(), boundary.points.size() + cuts);
    EXPECT_TRUE(check_invariants(tri).empty()) << seed << ": " << check_invariants(tri).front();
    EXPECT_EQ(split_spanning_sides(tri), 0);
  }
}

}  // namespace
}  // namespace delquad
