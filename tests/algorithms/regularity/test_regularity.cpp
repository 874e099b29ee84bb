// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/algorithms/stages.h"

namespace delquad {
namespace {

QuadPatch meshed(const PatchBoundary& boundary, const ParametricSize& size,
                 const CrossField& cross = FunctionCross(0.3)) {
  return treat_paper(matched(boundary, size, cross), size);
}

/// A grid in which edges were turned at random, so that pairs of three and five wander, four irregular
/// vertices at most; relocated.
QuadPatch with_two_pairs(int nx, int ny, std::uint64_t seed) {
  QuadTopology topology(grid_patch(nx, ny));
  std::mt19937_64 random(seed);
  for (int i = 0; i < 2000; ++i) {
    const int h = static_cast<int>(random() % (4 * topology.element_slots()));
    const bool forward = random() % 2 == 0;
    bool near = false;
    for (const int v : topology.twin(h) < 0 ? std::array<int, 6>{} : topology.hexagon(h))
      near |= topology.on_boundary(v);
    if (near || !topology.can_rotate(h, forward)) continue;
    const auto start = topology.mark();
    topology.rotate(h, forward);
    int irregular = 0;
    bool bad = false;
    for (int v = 0; v < topology.vertex_slots(); ++v)
      if (!topology.on_boundary(v)) {
        irregular += topology.valence(v) != 4;
        bad |= std::abs(topology.valence(v) - 4) > 1;
      }
    if (bad || irregular > 4 || irregular == 0)
      topology.rollback(start);
    else
      topology.commit();
  }
  const FunctionSize size(1);
  QuadRelocation relocation(topology, size);
  relocation.activate_all();
  relocation.relax(0.01, 200);
  return topology.to_patch();
}

TEST(Regularity, TriesNothingOnARegularGrid) {
  RegularitySummary summary;
  regular(grid_patch(7, 5), shapes::rectangle(7, 5, 7, 5), FunctionSize(1), {}, &summary);
  EXPECT_EQ(summary.cavities, 0);
}

TEST(Regularity, OppositePairsBecomeTheGrid) {
  for (int seed = 0; seed < 10; ++seed) {
    SCOPED_TRACE(seed);
    const QuadPatch mesh = with_two_pairs(16, 13, seed);
    ASSERT_EQ(count_irregular(mesh), 4);
    RegularitySummary summary;
    const QuadPatch result = regular(mesh, shapes::rectangle(16, 13, 16, 13), FunctionSize(1), {}, &summary);
    EXPECT_EQ(summary.irregular_after, 0);
    EXPECT_EQ(result.quads.size(), 16u * 13);
    EXPECT_GT(worst_sine(result), 0.99);
    EXPECT_GT(summary.grids, 0);
  }
}

TEST(Regularity, PairsFarApartNeedNoTolerance) {
  for (int seed = 0; seed < 20; ++seed) {
    const QuadPatch mesh = with_two_pairs(16, 13, seed);
    const PatchBoundary boundary = shapes::rectangle(16, 13, 16, 13);
    EXPECT_EQ(count_irregular(regular(mesh, boundary, FunctionSize(1), {.tolerance = 0})), 0) << seed;
  }
}

TEST(Regularity, WhatACornerForbidsIsNotTriedAgain) {
  const FunctionSize size(0.06);
  for (int seed = 0; seed < 8; ++seed) {
    const PatchBoundary boundary = shapes::random_polygon_with_holes(seed, 0.06);
    const QuadPatch mesh = cleaned(meshed(boundary, size), size);
    RegularitySummary some, more;
    make_regular(mesh, size, {.tolerance = 0, .rounds = 20}, &some);
    make_regular(mesh, size, {.tolerance = 0, .rounds = 40}, &more);
    EXPECT_EQ(some.tried, more.tried) << seed;
  }
}

/// The lengths of all sides, over delta.
double longest_side(const QuadPatch& mesh, double delta) {
  double longest = 0;
  for (const auto& quad : mesh.quads)
    for (int k = 0; k < 4; ++k)
      longest = std::max(longest, norm(mesh.points[quad[(k + 1) % 4]] - mesh.points[quad[k]]) / delta);
  return longest;
}

TEST(Regularity, SidesStayShortWhateverTheTolerance) {
  const double delta = 0.02;
  const FunctionSize size(delta);
  for (int seed = 0; seed < 4; ++seed) {
    const PatchBoundary boundary = shapes::random_polygon_with_holes(seed, delta);
    const QuadPatch mesh = cleaned(meshed(boundary, size), size);
    const QuadPatch result = regular(mesh, boundary, size, {.tolerance = 30, .quads = 1000});
    EXPECT_LT(count_irregular(result), count_irregular(mesh) / 2) << seed;
    // Fills are relaxed once more when they are kept.
    EXPECT_LT(longest_side(result, delta), std::max(2.8, 1.01 * longest_side(mesh, delta))) << seed;
  }
}

TEST(Regularity, NothingIsPaidWithoutTolerance) {
  const auto mean = [](const QuadPatch& mesh) {
    const QuadTopology topology(mesh);
    double sum = 0;
    for (int e = 0; e < topology.element_slots(); ++e) sum += eta_of_sine(least_sine(topology, e));
    return sum / topology.element_slots();
  };
  const FunctionSize size(0.06);
  int without = 0, with = 0;
  for (int seed = 0; seed < 4; ++seed) {
    const PatchBoundary boundary = shapes::random_polygon_with_holes(seed, 0.06);
    const QuadPatch mesh = cleaned(meshed(boundary, size), size);
    const QuadPatch result = regular(mesh, boundary, size, {.tolerance = 0, .rounds = 1});
    EXPECT_GE(mean(result), mean(mesh) - 0.002) << seed;
    without += count_irregular(result);
    with += count_irregular(regular(mesh, boundary, size, {.tolerance = 10}));
  }
  EXPECT_LT(with, 0.8 * without);
}

TEST(Regularity, FewerThanTheTreatmentLeaves) {
  const FunctionSize size(0.03);
  const PatchBoundary boundary = shapes::rectangle(1, 0.9, 34, 30);
  const QuadPatch mesh = meshed(boundary, size);
  ASSERT_GT(count_irregular(mesh), 20);
  EXPECT_LT(count_irregular(regular(mesh, boundary, size)), 0.6 * count_irregular(mesh));
}

TEST(Regularity, RandomPolygonsWithHoles) {
  const FunctionSize size(0.06);
  for (int seed = 0; seed < 8; ++seed) {
    SCOPED_TRACE(seed);
    const PatchBoundary boundary = shapes::random_polygon_with_holes(seed, 0.06);
    const auto placement = seed % 2 == 0 ? make_linf_delquad() : make_l2_frontal();
    const QuadPatch mesh = treat_paper(matched(boundary, size, FunctionCross(0.3), *placement), size);
    regular(mesh, boundary, size);
    regular(cleaned(mesh, size), boundary, size);
  }
}

TEST(Regularity, NoVerticesNearlyCoincide) {
  for (int seed = 0; seed < 10; ++seed) {
    const PatchBoundary boundary = shapes::rotated(shapes::plate_with_holes(3, 20, 3, 0.3, 13), 0.1 * seed);
    const FunctionSize size([&](Vec2 p) { return 0.15 * std::exp(0.5 * std::sin(3 * p.x + seed)); });
    const QuadPatch mesh = meshed(boundary, size, FunctionCross(0.1 * seed));
    // What was narrow before may not be so afterwards.
    const double least = std::min(kShortSide, least_room(mesh, size)) / 2;
    EXPECT_GE(least_room(regular(mesh, boundary, size, {.tolerance = 20}), size), least) << seed;
  }
}

TEST(Regularity, ManyIrregularVerticesInOnePlace) {
  for (int seed = 0; seed < 5; ++seed) {
    SCOPED_TRACE(seed);
    const QuadPatch mesh = scrambled(grid_patch(14, 14), seed, 400);
    RegularitySummary summary;
    regular(mesh, shapes::rectangle(14, 14, 14, 14), FunctionSize(1), {}, &summary);
    // Each visit tries a few, and is made when something around was filled or another round begins.
    EXPECT_LT(summary.tried, 60 * summary.irregular_before);
  }
}

TEST(Regularity, AllVerticesOnTheBoundary) {
  // Eight quads around a hole.
  PatchBoundary boundary = shapes::rectangle(3, 3, 3, 3);
  QuadPatch mesh = grid_patch(3, 3);
  std::vector<std::array<int, 4>> ring;
  for (const auto& quad : mesh.quads)
    if (std::ranges::any_of(quad, [&](int v) { return v < mesh.n_boundary; })) ring.push_back(quad);
  ASSERT_EQ(ring.size(), 8u);
  mesh.quads = ring;
  const int n = mesh.n_boundary;
  mesh.n_boundary = static_cast<int>(mesh.points.size());
  // The hole's outline: sides that one quad has, between what were vertices inside.
  for (const auto& quad : ring)
    for (int k = 0; k < 4; ++k)
      if (const int a = quad[k], b = quad[(k + 1) % 4]; a >= n && b >= n) boundary.edges.push_back({a, b});
  boundary.points = mesh.points;
  RegularitySummary summary;
  EXPECT_EQ(regular(mesh, boundary, FunctionSize(1), {}, &summary).quads, mesh.quads);
  EXPECT_EQ(summary.tried, 0);
}

TEST(Regularity, HoleOfThreeEdges) {
  PatchBoundary boundary = shapes::rectangle(1, 1, 13, 14);
  const int n = static_cast<int>(boundary.points.size());
  for (int k = 0; k < 3; ++k) {
    const double angle = -2 * std::numbers::pi * k / 3;
    boundary.points.push_back({0.5 + 0.05 * std::cos(angle), 0.5 + 0.05 * std::sin(angle)});
    boundary.edges.push_back({n + k, n + (k + 1) % 3});
  }
  const FunctionSize size(0.075);
  const QuadPatch mesh = meshed(boundary, size);
  EXPECT_EQ(mesh.triangles.size(), 1u) << "an odd number of edges";
  regular(mesh, boundary, size);
}

TEST(Regularity, SizesGradedByAThousand) {
  const FunctionSize size([](Vec2 p) { return 0.001 + 0.3 * norm(p); });
  PatchBoundary boundary;
  std::vector<Vec2> corners = {{0, 0}};
  for (double x = 0.001; x < 3; x += 0.001 + 0.3 * x) corners.push_back({x, 0});
  corners.insert(corners.end(), {{3.5, 0}, {3.5, 1}, {3.5, 2}, {3.5, 3.5}, {2, 3.5}, {1, 3.5}, {0, 3.5}});
  for (std::size_t i = corners.size() - 8; i > 0; --i) corners.push_back({0, corners[i].x});
  shapes::add_polygon(boundary, corners, std::vector<int>(corners.size(), 1));
  ASSERT_EQ(boundary.points.size() % 2, 0u);
  regular(meshed(boundary, size), boundary, size);
}

}  // namespace
}  // namespace delquad
