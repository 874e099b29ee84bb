// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/algorithms/stages.h"

namespace delquad {
namespace {

TEST(Treatment, ScrambledGridRecovers) {
  for (int seed = 0; seed < 5; ++seed) {
    const QuadPatch mesh = scrambled(grid_patch(20, 20), seed, 60);
    ASSERT_LT(worst_sine(mesh), 0.01);
    const QuadPatch result = treated(mesh, shapes::rectangle(20, 20, 20, 20), FunctionSize(1));
    EXPECT_GT(worst_sine(result), std::sin(0.3 * std::numbers::pi / 2));
    EXPECT_GT(regular_share(result), std::max(0.9, regular_share(mesh)));
  }
}

TEST(Treatment, FlatBoundaryVertexWithOneQuad) {
  // A corner cut off by one quad whose second vertex is flat, as matching leaves it where two triangles of a
  // corner merge.
  QuadPatch mesh = grid_patch(4, 4);
  QuadTopology topology(mesh);
  int h = -1;
  topology.for_each_out(1, [&](int g) {
    if (topology.twin(g) >= 0) h = g;
  });
  ASSERT_TRUE(topology.can_rotate(h, false));
  topology.rotate(h, false);
  mesh = topology.to_patch();
  ASSERT_EQ(QuadTopology(mesh).valence(1), 1);
  ASSERT_LT(worst_sine(mesh), 1e-12);
  // The rotation back repairs it where it may; when the corner's own quad is all there is, only new vertices
  // do.
  const QuadPatch back = treated(mesh, shapes::rectangle(4, 4, 4, 4), FunctionSize(1));
  EXPECT_GT(worst_sine(back), 0.999);  // relocation stops at 1 % of an edge
  QuadPatch alone;
  alone.points = {{0, 0}, {1, 0}, {2, 0}, {1, 1.5}};
  alone.quads = {{0, 1, 2, 3}};
  alone.n_boundary = 4;
  ASSERT_EQ(worst_sine(alone), 0);
  const QuadPatch repaired =
      treated(alone, shapes::polygon({{0, 0}, {1, 0}, {2, 0}, {1, 1.5}}), FunctionSize(1));
  EXPECT_EQ(repaired.quads.size(), 5u);
  EXPECT_GT(worst_sine(repaired), 0.3);
}

TEST(Treatment, RandomPolygonsWithHoles) {
  const FunctionSize size(0.06);
  for (int seed = 0; seed < 30; ++seed) {
    const PatchBoundary boundary = shapes::random_polygon_with_holes(seed, 0.06);
    const auto placement = seed % 2 == 0 ? make_linf_delquad() : make_l2_frontal();
    const QuadPatch mesh = matched(boundary, size, FunctionCross(0.3), *placement);
    const QuadPatch result = treated(mesh, boundary, size);
    EXPECT_GE(worst_sine(result), worst_sine(mesh)) << "seed " << seed;
    EXPECT_GT(worst_sine(result), 0) << "seed " << seed;
    EXPECT_GT(regular_share(result), regular_share(mesh)) << "seed " << seed;
    expect_same(treat_paper(mesh, size), result);
  }
}

TEST(Treatment, BoundaryMuchFinerThanTheSize) {
  const FunctionSize size([](Vec2 p) { return 0.03 * (1 + 4 * norm(p)); });
  for (int seed = 0; seed < 10; ++seed) {
    const PatchBoundary boundary = shapes::random_polygon_with_holes(seed, 0.03);
    treated(matched(boundary, size, FunctionCross(0)), boundary, size);
  }
}

TEST(Treatment, NoVerticesNearlyCoincide) {
  const FunctionSize size(0.15);
  for (int seed = 0; seed < 10; ++seed) {
    const PatchBoundary boundary = shapes::rotated(shapes::plate_with_holes(3, 20, 3, 0.3, 13), 0.1 * seed);
    const auto placement = seed % 2 == 0 ? make_linf_delquad() : make_l2_frontal();
    const QuadPatch mesh = matched(boundary, size, FunctionCross(0.1 * seed), *placement);
    EXPECT_GT(least_room(mesh, size), kShortSide) << seed;
    EXPECT_GT(least_room(treated(mesh, boundary, size), size), kShortSide) << seed;
  }
}

TEST(Treatment, StrongGrading) {
  const FunctionSize size([](Vec2 p) {
    const double g = p.x - p.y * p.y;
    return 0.02 * (1 + 30 * g * g + (1 - p.x) * (1 - p.x));
  });
  PatchBoundary boundary = shapes::rectangle(1, 1, 20, 24);
  const QuadPatch result = treated(matched(boundary, size, FunctionCross(0)), boundary, size);
  // The boundary does not follow the size, which goes from half to fifteen times its edges.
  EXPECT_GT(worst_sine(result), std::sin(0.1 * std::numbers::pi / 2));
}

TEST(Treatment, RoundsAreLimited) {
  const QuadPatch mesh = scrambled(grid_patch(20, 20), 1, 60);
  const FunctionSize size(1);
  TreatmentSummary summary;
  const QuadPatch untouched = treat_paper(mesh, size, {.max_rounds = 0}, &summary);
  EXPECT_EQ(summary.rounds, 0);
  EXPECT_EQ(summary.swaps + summary.diamonds + summary.doublets + summary.boundary_repairs, 0);
  EXPECT_EQ(untouched.quads, mesh.quads);
  EXPECT_GT(summary.relocated, 0);
  treat_paper(mesh, size, {.max_rounds = 1}, &summary);
  EXPECT_EQ(summary.rounds, 1);
}

}  // namespace
}  // namespace delquad
