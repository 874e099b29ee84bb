// SPDX-License-Identifier: GPL-3.0-or-later
#include "algorithms/recombination/dual_graph.h"
#include "tests/algorithms/stages.h"

namespace delquad {
namespace {

double worst_eta(const QuadPatch& mesh) {
  double worst = 1;
  for (const auto& q : mesh.quads) {
    worst = std::min(worst,
                     signed_eta(mesh.points[q[0]], mesh.points[q[1]], mesh.points[q[2]], mesh.points[q[3]]));
  }
  return worst;
}

/// The quads as rotated to start with their smallest index, sorted.
std::set<std::array<int, 4>> normalised(const QuadPatch& mesh) {
  std::set<std::array<int, 4>> quads;
  for (auto q : mesh.quads) {
    std::rotate(q.begin(), std::min_element(q.begin(), q.end()), q.end());
    quads.insert(q);
  }
  return quads;
}

// Point 0 is b; then counterclockwise p, q, m, r, s.
QuadPatch fan_with_one_quad(Vec2 p, Vec2 q, Vec2 m, Vec2 r, Vec2 s) {
  QuadPatch mesh;
  mesh.points = {{0, 0}, p, q, m, r, s};
  mesh.quads = {{0, 2, 3, 4}};
  mesh.n_boundary = 6;
  return mesh;
}
const FanEnds kEnds = {{0, 1, 2}, {0, 4, 5}};

TEST(BoundaryRepair, SwapsAPentagonThatIsTwoSquares) {
  QuadPatch mesh = fan_with_one_quad({1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0});
  const BoundaryRepairSummary summary = repair_fans(mesh, {kEnds});
  EXPECT_EQ(summary.pentagon_swaps, 1);
  EXPECT_EQ(summary.duplications, 0);
  EXPECT_EQ(normalised(mesh), (std::set<std::array<int, 4>>{{0, 1, 2, 3}, {0, 3, 4, 5}}));
  EXPECT_EQ(mesh.points.size(), 6u);
  EXPECT_DOUBLE_EQ(worst_eta(mesh), 1);
}

TEST(BoundaryRepair, DuplicatesWhereTheSwapWouldBeWorse) {
  // The swap would leave angles of 45 degrees at m.
  QuadPatch mesh = fan_with_one_quad({1, 0}, {1, 1}, {0, 2}, {-1, 1}, {-1, 0});
  const BoundaryRepairSummary summary = repair_fans(mesh, {kEnds});
  EXPECT_EQ(summary.pentagon_swaps, 0);
  EXPECT_EQ(summary.duplications, 1);
  ASSERT_EQ(mesh.points.size(), 7u);
  EXPECT_EQ(normalised(mesh), (std::set<std::array<int, 4>>{{0, 1, 2, 6}, {0, 6, 4, 5}, {2, 3, 4, 6}}));
  EXPECT_GT(worst_eta(mesh), 0.55);
  EXPECT_NEAR(mesh.points[6].x, 0, 0.05);
}

TEST(BoundaryRepair, NeverSwapsIntoARepeatedVertex) {
  // The quad between runs back along the first end: its far corner is p.
  QuadPatch mesh;
  mesh.points = {{0, 0}, {1, 0}, {0.4, 0.3}, {0, 1}, {-1, 0}};
  mesh.quads = {{0, 2, 1, 3}};
  mesh.n_boundary = 5;
  const BoundaryRepairSummary summary = repair_fans(mesh, {{{0, 1, 2}, {0, 3, 4}}});
  EXPECT_EQ(summary.duplications, 1);
  EXPECT_EQ(normalised(mesh), (std::set<std::array<int, 4>>{{0, 1, 2, 5}, {0, 5, 3, 4}, {1, 3, 5, 2}}));
}

TEST(BoundaryRepair, DuplicatesOverSeveralElementsAndKeepsLeftovers) {
  // Two quads and a triangle that stays one between the ends, on a reflex corner of 270 degrees.
  QuadPatch mesh;
  mesh.points = {{0, 0}, {1, -1}, {2, 0}, {2, 2}, {0, 2}, {-1, 2}, {-2, 1}, {-2, 0}, {-1, -1}};
  mesh.quads = {{0, 2, 3, 4}, {0, 5, 6, 7}};
  mesh.triangles = {{0, 4, 5}};
  mesh.n_boundary = 9;
  const BoundaryRepairSummary summary = repair_fans(mesh, {{{0, 1, 2}, {0, 7, 8}}});
  EXPECT_EQ(summary.duplications, 1);
  EXPECT_EQ(normalised(mesh),
            (std::set<std::array<int, 4>>{{0, 1, 2, 9}, {0, 9, 7, 8}, {2, 3, 4, 9}, {5, 6, 7, 9}}));
  ASSERT_EQ(mesh.triangles.size(), 1u);
  EXPECT_EQ(mesh.triangles[0], (std::array<int, 3>{9, 4, 5}));
  EXPECT_GT(worst_eta(mesh), 0.2);
}

TEST(BoundaryRepair, OppositeFansThatShareTheirQuadMakeFourSquares) {
  // The fans of (0, 0) and (0, 2) share the rhombus between. The first is repaired by duplication, which
  // leaves one quad to swap with the second; the duplicate then settles in the middle.
  QuadPatch mesh;
  mesh.points = {{0, 0}, {1, 0}, {1, 1}, {1, 2}, {0, 2}, {-1, 2}, {-1, 1}, {-1, 0}};
  mesh.quads = {{0, 2, 4, 6}};
  mesh.n_boundary = 8;
  const BoundaryRepairSummary summary = repair_fans(mesh, {{{0, 1, 2}, {0, 6, 7}}, {{4, 5, 6}, {4, 2, 3}}});
  EXPECT_EQ(summary.duplications, 1);
  EXPECT_EQ(summary.pentagon_swaps, 1);
  EXPECT_EQ(normalised(mesh),
            (std::set<std::array<int, 4>>{{0, 1, 2, 8}, {0, 8, 6, 7}, {2, 3, 4, 8}, {4, 5, 6, 8}}));
  EXPECT_GT(worst_eta(mesh), 0.99);  // the search for the place stops at a thousandth of the star
}

}  // namespace
}  // namespace delquad
