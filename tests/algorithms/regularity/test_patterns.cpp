// SPDX-License-Identifier: GPL-3.0-or-later
#include "algorithms/regularity/patterns.h"
#include "algorithms/regularity/polygon_sides.h"
#include "tests/algorithms/stages.h"

namespace delquad {
namespace {

/// More irregular vertices than any pattern here has.
constexpr int kMostIrregular = 100;

/// A polygon whose corners are given, with vertices a unit apart (about; `edges` of each side are given).
Outline polygon_outline(const std::vector<Vec2>& corners, const std::vector<int>& edges,
                        const std::vector<int>& turns) {
  Outline outline;
  const std::size_t n = corners.size();
  for (std::size_t i = 0; i < n; ++i)
    for (int k = 0; k < edges[i]; ++k) {
      const double t = double(k) / edges[i];
      outline.places.push_back((1 - t) * corners[i] + t * corners[(i + 1) % n]);
      outline.delta.push_back(norm(corners[(i + 1) % n] - corners[i]) / edges[i]);
      outline.turn.push_back(k == 0 ? turns[i] : 0);
    }
  return outline;
}

/// With corners on a circle.
Outline convex_outline(const std::vector<int>& edges) {
  const int total = std::reduce(edges.begin(), edges.end());
  const double radius = total / (2 * std::numbers::pi);
  std::vector<Vec2> corners;
  for (int i = 0, at = 0; i < static_cast<int>(edges.size()); at += edges[i++]) {
    const double angle = 2 * std::numbers::pi * at / total;
    corners.push_back({radius * std::cos(angle), radius * std::sin(angle)});
  }
  return polygon_outline(corners, edges, std::vector<int>(edges.size(), 1));
}

QuadPatch filled(const Outline& outline, const Pattern& pattern) {
  const PatternMesh mesh = mesh_pattern(outline, pattern);
  QuadPatch patch;
  patch.points = outline.places;
  patch.n_boundary = static_cast<int>(patch.points.size());
  patch.points.insert(patch.points.end(), mesh.inside.begin(), mesh.inside.end());
  patch.quads = mesh.quads;
  return patch;
}

std::optional<int> least_irregular(const Outline& outline, int most = kMostIrregular) {
  const auto pattern = best_pattern(outline, most);
  return pattern ? std::optional(irregular_vertices(*pattern)) : std::nullopt;
}

/// The mesh of the best pattern, a conforming disk. All vertices have the quads they should have, but for as
/// many irregular ones as the pattern has. Empty where there is none.
QuadPatch expect_filled(const Outline& outline) {
  const std::optional<Pattern> pattern = best_pattern(outline, kMostIrregular);
  if (!pattern) return {};
  const int least = irregular_vertices(*pattern);
  const std::optional<Pattern> again = best_pattern(outline, least);
  EXPECT_TRUE(again && again->strain == pattern->strain) << "that more would do makes no difference";
  EXPECT_FALSE(best_pattern(outline, least - 1));
  const QuadPatch patch = filled(outline, *pattern);
  PatchBoundary boundary;
  boundary.points = outline.places;
  for (int i = 0; i < patch.n_boundary; ++i) boundary.edges.push_back({i, (i + 1) % patch.n_boundary});
  expect_sound(patch, boundary);
  const QuadTopology topology(patch);
  int irregular = 0;
  for (int v = 0; v < topology.vertex_slots(); ++v) {
    const int valence = topology.valence(v);
    if (v < patch.n_boundary) {
      const int more = valence - (2 - outline.turn[v]);
      EXPECT_TRUE(more == 0 || more == 1) << "rim " << v;
      irregular += more;
    } else {
      EXPECT_TRUE(valence >= 3 && valence <= 5) << valence;
      irregular += valence != 4;
    }
  }
  EXPECT_EQ(irregular, least);
  return patch;
}

TEST(Patterns, Grid) {
  const QuadPatch patch =
      expect_filled(polygon_outline({{0, 0}, {5, 0}, {5, 3}, {0, 3}}, {5, 3, 5, 3}, {1, 1, 1, 1}));
  EXPECT_EQ(patch.quads.size(), 15u);
  EXPECT_GT(worst_sine(patch), 1 - 1e-12);
}

TEST(Patterns, StarsHaveTheirPlaceByTheSides) {
  for (const auto& edges :
       {std::vector{4, 4, 4}, {3, 4, 5}, {2, 2, 2}, {2, 2, 2, 2, 2}, {4, 5, 4, 4, 5}, {7, 3, 6, 5, 3}}) {
    const QuadPatch patch = expect_filled(convex_outline(edges));
    ASSERT_FALSE(patch.quads.empty());
    EXPECT_GT(worst_sine(patch), 0);
  }
  EXPECT_FALSE(least_irregular(convex_outline({2, 2, 4}))) << "the third arm has no length";
  EXPECT_FALSE(least_irregular(convex_outline({3, 3, 3}))) << "an odd number of edges";
}

TEST(Patterns, PairsWhereOppositeSidesDiffer) {
  for (int a = 4; a < 9; ++a)
    for (int b = 4; b < 9; ++b)
      for (int more = 1; more < 4; ++more) {
        const Outline outline = convex_outline({a, b, a + more, b + more});
        const QuadPatch patch = expect_filled(outline);
        ASSERT_EQ(least_irregular(outline), 2);
        EXPECT_GT(worst_sine(patch), 0) << a << " " << b << " " << more;
      }
}

TEST(Patterns, TwoStars) {
  for (const auto& edges : {std::vector{6, 6}, {5, 7}, {4, 4, 4, 4, 4, 4}, {5, 4, 6, 5, 4, 6}}) {
    const Outline outline = convex_outline(edges);
    expect_filled(outline);
    EXPECT_EQ(least_irregular(outline), 2);
  }
}

TEST(Patterns, ConcaveCornerIsCut) {
  const std::vector<Vec2> l = {{0, 0}, {8, 0}, {8, 3}, {4, 3}, {4, 7}, {0, 7}};
  const Outline outline = polygon_outline(l, {8, 3, 4, 4, 4, 7}, {1, 1, 1, -1, 1, 1});
  const QuadPatch patch = expect_filled(outline);
  EXPECT_EQ(least_irregular(outline), 0);
  EXPECT_EQ(patch.quads.size(), 8u * 3 + 4u * 4);
  EXPECT_GT(worst_sine(patch), 1 - 1e-12);
  // Two edges too many on one side.
  const Outline longer = polygon_outline(l, {10, 3, 4, 4, 4, 7}, {1, 1, 1, -1, 1, 1});
  EXPECT_EQ(least_irregular(longer), 2);
  EXPECT_GT(worst_sine(expect_filled(longer)), 0);
}

TEST(Patterns, CentreOnASide) {
  // Feet at 2, 0, 2, 3, 2.
  const Outline outline = convex_outline({4, 3, 4, 5, 2});
  EXPECT_EQ(star_feet(std::array{4, 3, 4, 5, 2}), (std::array{2, 0, 2, 3, 2}));
  const QuadPatch patch = expect_filled(outline);
  EXPECT_EQ(least_irregular(outline), 1);
  EXPECT_EQ(QuadTopology(patch).valence(2), 3) << "the third vertex of the first side";
  EXPECT_GT(worst_sine(patch), 0);
}

TEST(Patterns, ManyCornersAreCutIntoPentagons) {
  for (const int n : {7, 8}) {
    const Outline outline = convex_outline(std::vector<int>(n, 4));
    EXPECT_GT(worst_sine(expect_filled(outline)), 0);
    EXPECT_EQ(least_irregular(outline), n - 4);
    EXPECT_FALSE(least_irregular(outline, n - 5));
  }
}

TEST(Patterns, ConcaveCornersAreCutOneAfterTheOther) {
  const std::vector<Vec2> u = {{0, 0}, {9, 0}, {9, 6}, {6, 6}, {6, 2}, {3, 2}, {3, 6}, {0, 6}};
  const std::vector<int> turns = {1, 1, 1, 1, -1, -1, 1, 1};
  const Outline outline = polygon_outline(u, {9, 6, 3, 4, 3, 4, 3, 6}, turns);
  const QuadPatch patch = expect_filled(outline);
  EXPECT_EQ(least_irregular(outline), 0);
  EXPECT_EQ(patch.quads.size(), 9u * 2 + 2 * 3 * 4);
  EXPECT_GT(worst_sine(patch), 1 - 1e-12);
  // A slit of no width: its end gets four quads.
  const std::vector<Vec2> slit = {{0, 0}, {8, 0}, {8, 6}, {4.1, 6}, {4, 2}, {3.9, 6}, {0, 6}};
  const Outline slotted = polygon_outline(slit, {8, 6, 4, 4, 4, 4, 6}, {1, 1, 1, 1, -2, 1, 1});
  EXPECT_EQ(least_irregular(slotted), 0);
  expect_filled(slotted);
}

TEST(Patterns, RandomPolygons) {
  std::mt19937_64 random(1);
  int found = 0;
  for (int round = 0; round < 600; ++round) {
    std::vector<int> edges(2 + random() % 7);
    for (int& n : edges) n = 1 + static_cast<int>(random() % 9);
    found += expect_filled(convex_outline(edges)).quads.empty() ? 0 : 1;
  }
  EXPECT_GT(found, 100);
}

TEST(Patterns, NoneForOtherPolygons) {
  EXPECT_FALSE(least_irregular(convex_outline({8})));
  EXPECT_FALSE(least_irregular(convex_outline(std::vector<int>(9, 4))));
  Outline round = convex_outline({4, 4, 4, 4});
  std::ranges::fill(round.turn, 0);
  EXPECT_FALSE(least_irregular(round));
  round.turn[0] = -2;
  EXPECT_FALSE(least_irregular(round));
}

}  // namespace
}  // namespace delquad
