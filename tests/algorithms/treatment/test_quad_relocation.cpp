// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/algorithms/stages.h"

namespace delquad {
namespace {

TEST(QuadRelocation, SinesOfCorners) {
  QuadPatch mesh;
  mesh.points = {{0, 0}, {2, 0}, {3, 1}, {1, 1}};
  mesh.quads = {{0, 1, 2, 3}};
  mesh.n_boundary = 4;
  for (const double sine : corner_sines(QuadTopology(mesh), 0)) EXPECT_NEAR(sine, std::sqrt(0.5), 1e-15);
  mesh.points[2] = {0.5, 0.25};  // reflex
  EXPECT_LT(least_sine(QuadTopology(mesh), 0), 0);
  mesh.points[2] = {2, 0};  // two corners in one place
  EXPECT_LE(least_sine(QuadTopology(mesh), 0), 0);
  mesh.points = {{0, 0}, {1, 0}, {0.5, std::sqrt(0.75)}};
  mesh.quads.clear();
  mesh.triangles = {{0, 1, 2}};
  mesh.n_boundary = 3;
  EXPECT_NEAR(least_sine(QuadTopology(mesh), 0), std::sin(std::numbers::pi / 3), 1e-15);
}

TEST(QuadRelocation, RegularGridStays) {
  const QuadPatch grid = grid_patch(6, 6);
  QuadTopology mesh(grid);
  const FunctionSize size(1);
  QuadRelocation relocation(mesh, size);
  relocation.activate_all();
  EXPECT_EQ(relocation.relax(1e-6, 50), 0);
  EXPECT_EQ(mesh.to_patch().points, grid.points);
}

TEST(QuadRelocation, JitteredGridBecomesRegular) {
  const QuadPatch grid = grid_patch(8, 7);
  QuadTopology mesh(jittered(grid, 3, 0.6));  // beyond validity
  EXPECT_LT(worst_sine(mesh), 0);
  const FunctionSize size(1);
  QuadRelocation relocation(mesh, size);
  relocation.activate_all();
  relocation.relax(1e-4, 500);
  // Steps below 1e-4 of an edge are not taken; slow modes of the sweeps leave some tens of that.
  for (int v = 0; v < mesh.vertex_slots(); ++v) EXPECT_LT(norm(mesh.point(v) - grid.points[v]), 0.01);
}

TEST(QuadRelocation, HoldsLengthsWhereItIsAsked) {
  QuadPatch strip = grid_patch(3, 2);
  for (Vec2& p : strip.points)
    if (p.y > 0) p.y = p.y == 1 ? 0.1 : 1;
  const FunctionSize size(1);
  const auto shortest = [&](bool hold) {
    QuadTopology mesh(strip);
    QuadRelocation relocation(mesh, size);
    if (hold) relocation.hold_lengths();
    relocation.activate_all();
    relocation.relax(1e-4, 100);
    double least = 1;
    for (int v = strip.n_boundary; v < mesh.vertex_slots(); ++v) least = std::min(least, mesh.point(v).y);
    return least;
  };
  EXPECT_LT(shortest(false), QuadLimits{}.shortest);
  EXPECT_GT(shortest(true), QuadLimits{}.shortest);
}

TEST(QuadRelocation, StepsNeverRaiseTheCost) {
  const FunctionSize size([](Vec2 p) { return 0.4 + 0.15 * p.x; });
  for (int seed = 0; seed < 20; ++seed) {
    QuadTopology mesh(jittered(scrambled(grid_patch(6, 6), seed, 40), seed, 0.5));
    QuadRelocation relocation(mesh, size);
    for (int v = mesh.to_patch().n_boundary; v < mesh.vertex_slots(); ++v) {
      const double before = relocation.cost(v);
      const double moved = relocation.step(v);
      EXPECT_TRUE(moved == 0 ? relocation.cost(v) == before : relocation.cost(v) < before);
      EXPECT_LE(moved, 0.4 * (1 + 1e-12));
    }
  }
}

TEST(QuadRelocation, UntanglesAVertexOutsideItsStar) {
  QuadPatch mesh = grid_patch(2, 2);
  mesh.points[8] = {1.6, 2.3};
  QuadTopology topology(mesh);
  ASSERT_LT(worst_sine(topology), 0);
  const FunctionSize size(1);
  QuadRelocation relocation(topology, size);
  relocation.activate_all();
  relocation.relax(1e-5, 100);
  EXPECT_NEAR(topology.point(8).x, 1, 1e-3);
  EXPECT_NEAR(topology.point(8).y, 1, 1e-3);
}

TEST(QuadRelocation, VertexLeavesTheCoarseSide) {
  QuadTopology mesh(grid_patch(2, 2));
  const FunctionSize size([](Vec2 p) { return p.x < 1.5 ? 0.8 : 1.6; });
  QuadRelocation relocation(mesh, size);
  relocation.activate_all();
  relocation.relax(1e-5, 100);
  EXPECT_LT(mesh.point(8).x, 0.99);  // the edge on its right is to be longer
  EXPECT_NEAR(mesh.point(8).y, 1, 1e-9);
}

TEST(QuadRelocation, HopelessSizesDoNotSpoilShapes) {
  // Boundary edges are a tenth of the wanted size: only angles can be had.
  QuadTopology mesh(jittered(grid_patch(8, 8), 5, 0.3));
  const FunctionSize size([](Vec2 p) { return 10 + p.x; });
  QuadRelocation relocation(mesh, size);
  relocation.activate_all();
  relocation.relax(1e-3, 200);
  EXPECT_GT(worst_sine(mesh), 0.95);
}

TEST(QuadRelocation, LiftImprovesTheWorstAndEnds) {
  for (int seed = 0; seed < 20; ++seed) {
    QuadTopology mesh(jittered(grid_patch(6, 6), seed, 0.55));
    const FunctionSize size(1);
    QuadRelocation relocation(mesh, size);
    const double before = worst_sine(mesh);
    EXPECT_GT(relocation.lift_worst(0.5, 20), 0);
    EXPECT_GE(worst_sine(mesh), before);
  }
}

TEST(QuadRelocation, VerticesKeepApart) {
  const FunctionSize size(1);
  for (int seed = 0; seed < 20; ++seed) {
    const QuadPatch mesh = scrambled(grid_patch(12, 12), seed, 40);
    ASSERT_GT(least_room(mesh, size), 0.2);
    QuadTopology topology(mesh);
    QuadRelocation relocation(topology, size);
    relocation.activate_all();
    relocation.relax(0.02, 30);
    relocation.lift_worst(0.5, 10);
    EXPECT_GE(least_room(topology.to_patch(), size), kShortSide) << seed;
  }
}

TEST(QuadRelocation, KeptSinesAreKept) {
  const double kept = 0.6;
  for (int seed = 0; seed < 10; ++seed) {
    const QuadPatch mesh = scrambled(grid_patch(9, 9), seed, 12);
    QuadTopology topology(mesh);
    const FunctionSize size(1);
    QuadRelocation relocation(topology, size);
    relocation.keep_sines_above(kept);
    std::vector<double> before;
    for (int e = 0; e < topology.element_slots(); ++e) before.push_back(least_sine(topology, e));
    const double worst = *std::min_element(before.begin(), before.end());
    relocation.activate_all();
    EXPECT_GT(relocation.relax(0.01, 20), 0);
    for (int e = 0; e < topology.element_slots(); ++e)
      EXPECT_GE(least_sine(topology, e), std::min(worst, kept));
  }
}

}  // namespace
}  // namespace delquad
