// SPDX-License-Identifier: GPL-3.0-or-later
#include "algorithms/recombination/dual_graph.h"
#include "tests/algorithms/stages.h"
#include "tests/support/tri_patches.h"

namespace delquad {
namespace {

double eta(const QuadPatch& mesh, const std::array<int, 4>& q) {
  return signed_eta(mesh.points[q[0]], mesh.points[q[1]], mesh.points[q[2]], mesh.points[q[3]]);
}

/// Four triangles in a row, of which the middle two make a square: the others are then left.
TEST(Greedy, BestPairsComeFirst) {
  const std::vector<Vec2> points = {{0, 0}, {1, 0}, {1.8, 0.4}, {1, 1}, {0, 1}, {-0.8, 1.3}};
  const TriPatch tri = make_patch(points, {{0, 4, 5}, {0, 1, 4}, {1, 3, 4}, {1, 2, 3}}, 6);
  GreedyOptions options;
  options.exchanges = 0;
  const QuadPatch one = recombine_greedily(tri, options);
  ASSERT_EQ(one.quads.size(), 1u);
  EXPECT_EQ(eta(one, one.quads[0]), 1);
  EXPECT_EQ(one.triangles.size(), 2u);
  // The others find partners when the square gives its triangles up.
  options.exchanges = 1;
  EXPECT_EQ(recombine_greedily(tri, options).quads.size(), 2u);
  options.least_eta = 0.4;  // which one of the two new quads does not reach
  EXPECT_EQ(recombine_greedily(tri, options).quads.size(), 1u);
}

TEST(Greedy, SquaresCutInTwoComeBack) {
  const PatchBoundary boundary = shapes::rectangle(1, 1, 8, 8, 0.3);
  const FunctionSize size(0.125);
  const TriPatch tri = mesh_frontal(boundary, *make_linf_delquad(), FunctionCross(0.3), size);
  const QuadPatch mesh = recombine_greedily(tri);
  EXPECT_EQ(mesh.quads.size(), 64u);
  for (const auto& q : mesh.quads) EXPECT_NEAR(eta(mesh, q), 1, 1e-9);
  expect_sound(treat_by_degrees(mesh, size), boundary);
}

/// Merged quads are good enough, other triangles have no free partner, and treatment keeps what it has to.
TEST(Greedy, RandomDomains) {
  const FunctionSize size([](Vec2 u) { return 0.03 + 0.1 * std::abs(std::sin(3 * u.x) * u.y); });
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE(seed);
    const PatchBoundary boundary = shapes::random_polygon_with_holes(seed, 0.06);
    const TriPatch tri = mesh_frontal(boundary, *make_l2_frontal(), FunctionCross(0.0), size);
    GreedyOptions options;
    options.exchanges = 0;
    const QuadPatch plain = recombine_greedily(tri, options);
    RecombineSummary summary;
    const QuadPatch mesh = recombine_greedily(tri, {}, &summary);
    expect_sound(mesh, boundary);
    for (const auto& q : mesh.quads) EXPECT_GE(eta(mesh, q), options.least_eta);
    EXPECT_EQ(2 * mesh.quads.size() + mesh.triangles.size(), tri.triangles.size());
    EXPECT_LE(mesh.triangles.size(), plain.triangles.size());
    EXPECT_EQ(summary.leftover_triangles, static_cast<int>(mesh.triangles.size()));

    TreatmentSummary treated;
    const QuadPatch result = treat_by_degrees(mesh, size, {}, &treated);
    expect_sound(result, boundary);
    EXPECT_EQ(result.triangles.size(), mesh.triangles.size());
    EXPECT_EQ(result.quads.size() + static_cast<std::size_t>(treated.diamonds + treated.doublets),
              mesh.quads.size());
    EXPECT_GE(worst_sine(result), std::min(0.5, worst_sine(mesh)) - 1e-12);
    EXPECT_GT(treated.relocated, 0);
  }
}

TEST(Greedy, LongestSidesOnly) {
  const PatchBoundary boundary = shapes::random_polygon_with_holes(3, 0.06);
  const TriPatch tri = mesh_frontal(boundary, *make_l2_frontal(), FunctionCross(0.0), FunctionSize(0.08));
  GreedyOptions options{0.5, true, 0};
  const QuadPatch mesh = recombine_greedily(tri, options);
  EXPECT_GT(mesh.quads.size(), 10u);
  for (const auto& q : mesh.quads) {
    const auto side = [&](int i, int j) { return norm(mesh.points[q[i]] - mesh.points[q[j]]); };
    // The diagonal that was taken out joins the second and the fourth corner.
    const double diagonal = side(1, 3);
    EXPECT_TRUE(diagonal >= std::max(side(0, 1), side(0, 3)) || diagonal >= std::max(side(2, 1), side(2, 3)));
    EXPECT_GE(eta(mesh, q), 0.5);
  }
}

TEST(Greedy, SharpCornersAndSlivers) {
  for (const double height : {0.3, 0.03, 0.003}) {
    const PatchBoundary boundary = shapes::polygon({{0, 0}, {1, -height}, {1, height}}, 8);
    const FunctionSize size(0.05);
    const QuadPatch mesh =
        recombine_greedily(mesh_frontal(boundary, *make_l2_frontal(), FunctionCross(0.0), size));
    expect_sound(mesh, boundary);
    expect_sound(treat_by_degrees(mesh, size), boundary);
  }
}

}  // namespace
}  // namespace delquad
