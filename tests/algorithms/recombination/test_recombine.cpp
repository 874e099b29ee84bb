// SPDX-License-Identifier: GPL-3.0-or-later
#include "algorithms/recombination/dual_graph.h"
#include "tests/algorithms/stages.h"
#include "tests/support/tri_patches.h"

namespace delquad {
namespace {

constexpr double kPerDegree = std::numbers::pi / 180;

double area(const QuadPatch& mesh, const std::array<int, 4>& q) {
  return cross(mesh.points[q[2]] - mesh.points[q[0]], mesh.points[q[3]] - mesh.points[q[1]]) / 2;
}

double eta(const QuadPatch& mesh, const std::array<int, 4>& q) {
  return signed_eta(mesh.points[q[0]], mesh.points[q[1]], mesh.points[q[2]], mesh.points[q[3]]);
}

/// Recombines and checks all that must hold for any input.
QuadPatch checked(const TriPatch& tri, const PatchBoundary& boundary, RecombineSummary& summary) {
  QuadPatch mesh = recombine(tri, *make_primal_dual_solver(), &summary);
  const auto wrong = check_quad_patch(mesh, boundary, 2 - count_loops(boundary));
  EXPECT_TRUE(wrong.empty()) << wrong.front();
  EXPECT_EQ(mesh.triangles.size(), boundary.edges.size() % 2);
  EXPECT_EQ(summary.leftover_triangles, static_cast<int>(mesh.triangles.size()));
  EXPECT_EQ(summary.matched_extra, summary.pentagon_swaps + summary.duplications);
  EXPECT_EQ(mesh.points.size(), tri.points.size() + summary.duplications + summary.split_chords);
  EXPECT_EQ(static_cast<int>(mesh.quads.size()),
            static_cast<int>(tri.triangles.size()) / 2 + summary.duplications + summary.split_chords);
  return mesh;
}

TEST(Recombine, SmallestDomains) {
  RecombineSummary summary;
  const PatchBoundary three = shapes::disk(1, 3);
  EXPECT_EQ(checked(constrained_delaunay(three), three, summary).triangles.size(), 1u);
  const PatchBoundary four = shapes::rectangle(2, 1, 1, 1);
  EXPECT_EQ(eta(checked(constrained_delaunay(four), four, summary), {0, 1, 2, 3}), 1);
  // A square hole that nearly fills its square.
  PatchBoundary ring = shapes::polygon({{0, 0}, {1, 0}, {1, 1}, {0, 1}});
  shapes::add_polygon(ring, {{0.1, 0.1}, {0.1, 0.9}, {0.9, 0.9}, {0.9, 0.1}}, {1, 1, 1, 1});
  EXPECT_EQ(checked(constrained_delaunay(ring), ring, summary).quads.size(), 4u);
}

TEST(Recombine, EveryTriangulationOfSmallPolygonsBecomesQuads) {
  int swaps = 0, duplications = 0, polygons = 0;
  for (int n = 3; n <= 10; ++n) {
    const PatchBoundary boundary = shapes::disk(1, n);
    for_each_polygon_triangulation(n, [&](const TriPatch& tri) {
      RecombineSummary summary;
      checked(tri, boundary, summary);
      swaps += summary.pentagon_swaps;
      duplications += summary.duplications;
      ++polygons;
    });
  }
  EXPECT_EQ(polygons, 1 + 2 + 5 + 14 + 42 + 132 + 429 + 1430);  // Catalan numbers
  EXPECT_GT(swaps, 0);
  EXPECT_GT(duplications, 0);
}

TEST(Recombine, CutsSpanningSidesWhenThereIsNoPerfectMatching) {
  // An inner hexagon of four triangles; on each of its sides a triangle and an ear. Taking away the middle
  // triangle and the six on the hexagon's sides leaves nine odd components.
  const int n = 18;
  const PatchBoundary boundary = shapes::disk(1, n);
  std::vector<std::array<int, 3>> triangles = {{0, 6, 12}, {0, 3, 6}, {6, 9, 12}, {12, 15, 0}};
  for (int i = 0; i < n; i += 3) {
    triangles.push_back({i, i + 1, (i + 3) % n});
    triangles.push_back({i + 1, i + 2, (i + 3) % n});
  }
  const TriPatch tri = make_patch(boundary.points, triangles, n);
  ASSERT_EQ(make_primal_dual_solver()->solve(build_dual_graph(tri).graph).status,
            MatchingStatus::kNotPerfect);
  RecombineSummary summary;
  checked(tri, boundary, summary);
  EXPECT_EQ(summary.split_chords, 15);
}

TEST(Recombine, CoarsePolygonsWithHoles) {
  for (unsigned seed = 0; seed < 150; ++seed) {
    const PatchBoundary boundary = shapes::random_polygon_with_holes(seed, seed % 3 == 0 ? 0 : 0.25);
    const int inner = seed % 5 == 0 ? 0 : static_cast<int>(seed);
    RecombineSummary summary;
    SCOPED_TRACE(seed);
    checked(constrained_delaunay(boundary, random_inner_points(boundary, seed, inner, 0.05)), boundary,
            summary);
  }
}

TEST(Recombine, RandomTriangulationsFullOfSlivers) {
  // Points that almost coincide with each other and with the boundary.
  for (unsigned seed = 0; seed < 60; ++seed) {
    const PatchBoundary boundary = shapes::random_polygon_with_holes(seed, 0.3);
    RecombineSummary summary;
    SCOPED_TRACE(seed);
    checked(constrained_delaunay(boundary, random_inner_points(boundary, seed, 300, 1e-9)), boundary,
            summary);
  }
}

TEST(Recombine, FrontalMeshesOfPolygonsWithHoles) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    const PatchBoundary boundary = shapes::random_polygon_with_holes(seed, 0.05);
    const FunctionSize size([](Vec2 u) { return 0.04 + 0.03 * u.x; });
    for (const auto& placement : {make_l2_frontal(), make_linf_delquad()}) {
      const TriPatch tri = mesh_frontal(boundary, *placement, FunctionCross(0.2), size);
      RecombineSummary summary;
      SCOPED_TRACE(seed);
      const QuadPatch mesh = checked(tri, boundary, summary);
      EXPECT_EQ(summary.split_chords, 0);
      double smallest = 1;
      for (const auto& q : mesh.quads) smallest = std::min(smallest, area(mesh, q));
      EXPECT_GT(smallest, 0);
    }
  }
}

TEST(Recombine, RotatedLatticeBecomesSquares) {
  for (const double angle : {0.0, 0.35, 0.6}) {
    const PatchBoundary boundary = shapes::rectangle(1, 1, 20, 20, angle);
    const TriPatch tri =
        mesh_frontal(boundary, *make_linf_delquad(), FunctionCross(angle), FunctionSize(0.05));
    RecombineSummary summary;
    const QuadPatch mesh = checked(tri, boundary, summary);
    EXPECT_EQ(mesh.quads.size(), 400u);
    for (const auto& q : mesh.quads) EXPECT_NEAR(eta(mesh, q), 1, 1e-9);
  }
}

TEST(Recombine, OddBoundaryLeavesTheOneTriangleWhoseAbsenceIsCheapest) {
  // A row of unit squares with a triangle on its end: that is the odd one.
  const PatchBoundary boundary =
      shapes::polygon({{0, 0}, {1, 0}, {2, 0}, {3, 0}, {3.5, 0.5}, {3, 1}, {2, 1}, {1, 1}, {0, 1}});
  RecombineSummary summary;
  const QuadPatch mesh = checked(constrained_delaunay(boundary), boundary, summary);
  ASSERT_EQ(mesh.triangles.size(), 1u);
  auto t = mesh.triangles[0];
  std::sort(t.begin(), t.end());
  EXPECT_EQ(t, (std::array<int, 3>{3, 4, 5}));
  EXPECT_EQ(summary.cost, 0);

  for (unsigned seed = 0; seed < 30; ++seed) {
    const PatchBoundary odd = shapes::disk(1, 2 * static_cast<int>(seed) + 5);
    SCOPED_TRACE(seed);
    checked(constrained_delaunay(odd, random_inner_points(odd, seed, 100, 0.1)), odd, summary);
  }
}

TEST(Recombine, EachComponentHasItsOwnParity) {
  const PatchBoundary squares = shapes::rectangle(1, 1, 2, 2), pentagon = shapes::disk(1, 5);
  TriPatch both = constrained_delaunay(squares, {{0.5, 0.5}});
  const TriPatch other = constrained_delaunay(pentagon);
  // Boundary points first: the square's inner point moves to the end.
  std::vector<Vec2> points = squares.points;
  for (const Vec2 p : other.points) points.push_back(p + Vec2{5, 0});
  points.push_back(both.points.back());
  const int inner = static_cast<int>(squares.points.size());
  for (auto& t : both.triangles) {
    for (int& v : t) v = v == inner ? static_cast<int>(points.size()) - 1 : v;
  }
  for (auto t : other.triangles) both.triangles.push_back({t[0] + inner, t[1] + inner, t[2] + inner});
  const TriPatch tri = make_patch(points, both.triangles, static_cast<int>(points.size()) - 1);
  RecombineSummary summary;
  const QuadPatch mesh = recombine(tri, *make_primal_dual_solver(), &summary);
  EXPECT_EQ(mesh.quads.size(), 5u);
  ASSERT_EQ(mesh.triangles.size(), 1u);
  EXPECT_GE(mesh.triangles[0][0], inner);
  // Two odd components: one triangle each, although the whole is even.
  std::vector<std::array<int, 3>> twice = other.triangles;
  for (auto t : other.triangles) twice.push_back({t[0] + 5, t[1] + 5, t[2] + 5});
  points = other.points;
  for (const Vec2 p : other.points) points.push_back(p + Vec2{5, 0});
  EXPECT_EQ(recombine(make_patch(points, twice, 10), *make_primal_dual_solver()).triangles.size(), 2u);
}

TEST(Recombine, SameInputSameMeshAndNumberingDoesNotMatter) {
  const PatchBoundary boundary = shapes::random_polygon_with_holes(11, 0.1);
  TriPatch tri = constrained_delaunay(boundary, random_inner_points(boundary, 2, 800, 0.03));
  RecombineSummary summary, shuffled_summary;
  const QuadPatch first = recombine(tri, *make_primal_dual_solver(), &summary);
  const QuadPatch second = recombine(tri, *make_primal_dual_solver());
  EXPECT_EQ(first.quads, second.quads);
  EXPECT_EQ(first.points, second.points);
  std::mt19937_64 random(1);
  auto triangles = tri.triangles;
  std::shuffle(triangles.begin(), triangles.end(), random);
  const TriPatch shuffled = make_patch(tri.points, triangles, tri.n_boundary);
  const QuadPatch third = checked(shuffled, boundary, shuffled_summary);
  EXPECT_EQ(summary.cost, shuffled_summary.cost);
}

/// The share of inner edges within 8 degrees of the cross.
double aligned_share(const QuadPatch& mesh, double theta) {
  std::map<std::array<int, 2>, int> edges;
  for (const auto& q : mesh.quads)
    for (int k = 0; k < 4; ++k) ++edges[{std::min(q[k], q[(k + 1) % 4]), std::max(q[k], q[(k + 1) % 4])}];
  double inner = 0, aligned = 0;
  for (const auto& [edge, quads] : edges) {
    if (quads < 2) continue;
    const Vec2 d = mesh.points[edge[1]] - mesh.points[edge[0]];
    ++inner;
    aligned += std::abs(std::remainder(std::atan2(d.y, d.x) - theta, std::numbers::pi / 2)) <= 8 * kPerDegree;
  }
  return aligned / inner;
}

// Squares with sides that the cross does not follow. Expected is a grid from the middle, with the triangles
// without partner joined along the sides, not by rows of rhombs across it.
TEST(Recombine, FollowsTheCrossWhereTheBoundaryIsAstray) {
  const auto boundary = shapes::rectangle(1, 1, 40, 40);
  const FunctionSize size(0.025), steep([](Vec2 u) { return 0.02 * std::exp(3 * (u.x + u.y)); });
  const auto placement = make_linf_delquad();
  const auto solver = make_primal_dual_solver();
  for (const double degrees : {0.0, 5.0, 87.0})
    EXPECT_FALSE(is_misaligned(boundary, FunctionCross(degrees * kPerDegree), size)) << degrees;
  for (const double degrees : {10.0, 20.0, 30.0, 45.0, 70.0}) {
    SCOPED_TRACE(degrees);
    const double theta = degrees * kPerDegree;
    const FunctionCross cross(theta);
    EXPECT_TRUE(is_misaligned(boundary, cross, size));
    EXPECT_FALSE(is_misaligned(boundary, cross, steep));
    const TriPatch tri = mesh_delquad(boundary, *placement, cross, size);
    EXPECT_GT(aligned_share(recombine(tri, *solver, nullptr, kMisalignedExtraEdgeCost), theta), 0.9);
    const TriPatch from_boundary = mesh_frontal(boundary, *placement, cross, size);
    EXPECT_LT(aligned_share(recombine(from_boundary, *solver), theta), 0.85);
  }
}

}  // namespace
}  // namespace delquad
