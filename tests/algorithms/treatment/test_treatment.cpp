#include "algorithms/treatment/treatment.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "algorithms/insertion/frontal_mesher.h"
#include "algorithms/recombination/recombine.h"
#include "delquad/extend.h"
#include "smoothing/relocation/quad_relocation.h"
#include "tests/support/analytic_fields.h"
#include "tests/support/quad_patch_checks.h"
#include "tests/support/quad_patches.h"

namespace delquad {
namespace {

using namespace testing_support;

/// Of the interior vertices.
double regular_share(const QuadPatch& mesh) {
  const QuadTopology topology(mesh);
  int regular = 0, interior = 0;
  for (int v = mesh.n_boundary; v < topology.vertex_slots(); ++v, ++interior)
    regular += topology.valence(v) == 4;
  return double(regular) / interior;
}

/// Treats and checks what must hold for any input.
QuadPatch treated(const QuadPatch& mesh, const PatchBoundary& boundary, const ParametricSize& size) {
  TreatmentSummary summary;
  const QuadPatch result = treat_paper(mesh, size, {}, &summary);
  expect_sound(result, boundary);
  EXPECT_EQ(result.triangles.size(), mesh.triangles.size());
  // Doublets and diamonds take one quad each, openings add two.
  EXPECT_EQ(static_cast<int>(result.quads.size()) - static_cast<int>(mesh.quads.size()),
            summary.ring_quads + 2 * summary.openings - summary.diamonds - summary.doublets);
  return result;
}

QuadPatch meshed(const PatchBoundary& boundary, const PointPlacement& placement, const CrossField& cross,
                 const ParametricSize& size) {
  return recombine(mesh_frontal(boundary, placement, cross, size), *make_primal_dual_solver());
}

TEST(Treatment, RegularGridStays) {
  const QuadPatch grid = grid_patch(7, 5);
  const QuadPatch result = treated(grid, shapes::rectangle(7, 5, 7, 5), FunctionSize(1));
  EXPECT_EQ(result.points, grid.points);
  EXPECT_EQ(result.quads, grid.quads);
}

TEST(Treatment, SmallestMeshes) {
  const QuadPatch one = treated(grid_patch(1, 1), shapes::rectangle(1, 1, 1, 1), FunctionSize(1));
  EXPECT_EQ(one.quads.size(), 1u);
  EXPECT_EQ(treated(triangle_patch(), shapes::disk(1, 3), FunctionSize(1)).triangles.size(), 1u);
}

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
  const FunctionCross cross(0.3);
  for (int seed = 0; seed < 30; ++seed) {
    const PatchBoundary boundary = shapes::random_polygon_with_holes(seed, 0.06);
    const auto placement = seed % 2 == 0 ? make_linf_delquad() : make_l2_frontal();
    const QuadPatch mesh = meshed(boundary, *placement, cross, size);
    const QuadPatch result = treated(mesh, boundary, size);
    EXPECT_GE(worst_sine(result), worst_sine(mesh)) << "seed " << seed;
    EXPECT_GT(worst_sine(result), 0) << "seed " << seed;
    EXPECT_GT(regular_share(result), regular_share(mesh)) << "seed " << seed;
    const QuadPatch again = treat_paper(mesh, size);
    EXPECT_EQ(again.points, result.points);
    EXPECT_EQ(again.quads, result.quads);
  }
}

TEST(Treatment, BoundaryMuchFinerThanTheSize) {
  const FunctionSize size([](Vec2 p) { return 0.03 * (1 + 4 * norm(p)); });
  const FunctionCross cross(0);
  for (int seed = 0; seed < 10; ++seed) {
    const PatchBoundary boundary = shapes::random_polygon_with_holes(seed, 0.03);
    const QuadPatch mesh = meshed(boundary, *make_linf_delquad(), cross, size);
    treated(mesh, boundary, size);
  }
}

TEST(Treatment, NoVerticesNearlyCoincide) {
  const FunctionSize size(0.15);
  for (int seed = 0; seed < 10; ++seed) {
    const PatchBoundary boundary = shapes::rotated(shapes::plate_with_holes(3, 20, 3, 0.3, 13), 0.1 * seed);
    const auto placement = seed % 2 == 0 ? make_linf_delquad() : make_l2_frontal();
    const QuadPatch mesh = meshed(boundary, *placement, FunctionCross(0.1 * seed), size);
    EXPECT_GT(least_room(mesh, size), kShortSide) << seed;
    EXPECT_GT(least_room(treated(mesh, boundary, size), size), kShortSide) << seed;
  }
}

TEST(Treatment, OddBoundaryKeepsItsTriangle) {
  PatchBoundary boundary = shapes::disk(1, 31);
  const FunctionSize size(0.2);
  const QuadPatch mesh = meshed(boundary, *make_linf_delquad(), FunctionCross(0), size);
  ASSERT_EQ(mesh.triangles.size(), 1u);
  EXPECT_GT(worst_sine(treated(mesh, boundary, size)), 0);
}

TEST(Treatment, StrongGrading) {
  const FunctionSize size([](Vec2 p) {
    const double g = p.x - p.y * p.y;
    return 0.02 * (1 + 30 * g * g + (1 - p.x) * (1 - p.x));
  });
  PatchBoundary boundary = shapes::rectangle(1, 1, 20, 24);
  const QuadPatch result =
      treated(meshed(boundary, *make_linf_delquad(), FunctionCross(0), size), boundary, size);
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
