// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/optimisation/planar_tracks.h"
#include "smoothing/optimisation/track_optimisation.h"
#include "smoothing/relocation/quad_relocation.h"
#include "tests/support/meshing.h"
#include "tests/support/quad_patch_checks.h"
#include "tests/support/quad_patches.h"

namespace delquad {
namespace {

const double kFloorSine = std::sin(kOptimisedFloorEta * std::numbers::pi / 2);

/// Untangles and optimizes a mesh of one patch; its boundary points have the `places`, or stay.
QuadPatch optimise_vertices(QuadPatch mesh, const ParametricSize& size, const CrossField& cross,
                            OptimisationSummary* summary = nullptr,
                            const std::vector<CurvePlace>& places = {},
                            const OptimisationOptions& options = {}) {
  const int untangled = untangle_flat(mesh, size);
  std::vector<int> nodes(mesh.n_boundary);
  std::iota(nodes.begin(), nodes.end(), 0);
  PlanarTracks tracks({mesh.points.begin(), mesh.points.begin() + mesh.n_boundary}, places,
                      {{&mesh, nodes, &cross}}, size);
  std::vector<Vec2> points = tracks.points();
  OptimisationSummary done = optimise_on_tracks(points, tracks.quads(), tracks, options);
  tracks.store(points);
  done.untangled = untangled;
  if (summary != nullptr) *summary = done;
  return mesh;
}

TEST(PlanarTracks, SameMeshForEveryNumberOfThreads) {
  // Some blocks, and what lies around their cuts.
  const QuadPatch mesh = jittered(grid_patch(220, 210), 3, 0.3);
  const auto points = on_threads({1, 2, 3, 7}, [&] {
    OptimisationSummary summary;
    const QuadPatch result = optimise_vertices(mesh, FunctionSize(1), FunctionCross(0), &summary);
    EXPECT_LT(summary.energy_after, summary.energy_before);
    EXPECT_GT(summary.worst_after, summary.worst_before);
    return result.points;
  });
  double farthest = 0;
  const QuadPatch grid = grid_patch(220, 210);
  for (std::size_t v = 0; v < grid.points.size(); ++v)
    farthest = std::max(farthest, norm(points[v] - grid.points[v]));
  EXPECT_LT(farthest, 0.3);
}

TEST(PlanarTracks, NodesSlideOnTheirCurves) {
  // The nodes of each side of a square are displaced along it: they go back to where the grid wants them.
  const QuadPatch grid = grid_patch(6, 6);
  QuadPatch mesh = grid;
  std::vector<CurvePlace> places(mesh.n_boundary);
  for (int side = 0; side < 4; ++side) {
    const auto segment = make_segment(grid.points[6 * side], grid.points[6 * (side + 1) % 24]);
    for (int k = 1; k < 6; ++k) {
      const double even = k / 6.0, t = even + 0.05 * std::sin(2 * std::numbers::pi * even + side);
      places[6 * side + k] = {segment, t, 0, 1};
      mesh.points[6 * side + k] = segment->point(t);
      EXPECT_LT(norm(mesh.points[6 * side + k] - grid.points[6 * side + k]), 0.31);
    }
  }
  const QuadPatch held = optimise_vertices(mesh, FunctionSize(1), FunctionCross(0));
  EXPECT_TRUE(std::equal(held.points.begin(), held.points.begin() + 24, mesh.points.begin()));
  const QuadPatch result = optimise_vertices(mesh, FunctionSize(1), FunctionCross(0), nullptr, places);
  for (std::size_t v = 0; v < grid.points.size(); ++v)
    EXPECT_LT(norm(result.points[v] - grid.points[v]), 0.02) << v;
}

TEST(PlanarTracks, HolesKeepTheirShape) {
  const auto ellipse = make_expression_curve("0.2*cos(t)", "0.11*sin(t)", 0, 2 * std::numbers::pi);
  const Mesh made =
      mesh(ModelMaker().rectangle({-1, -0.75}, {1, 0.75}).loop({ellipse}).problem(0.08), "DBQO").mesh;
  double hole = 3;
  for (const auto& [a, b, c, d] : made.quads)
    hole -= cross(made.points[c] - made.points[a], made.points[d] - made.points[b]).z / 2;
  EXPECT_GT(hole, 0.93 * std::numbers::pi * 0.2 * 0.11);  // 0.95 by edges of one length
}

TEST(QuadOptimisation, JitteredGridBecomesRegular) {
  const QuadPatch grid = grid_patch(8, 7);
  OptimisationSummary summary;
  const QuadPatch result =
      optimise_vertices(jittered(grid, 3, 0.3), FunctionSize(1), FunctionCross(0), &summary);
  for (std::size_t v = 0; v < grid.points.size(); ++v)
    EXPECT_LT(norm(result.points[v] - grid.points[v]), 0.02);
  EXPECT_EQ(result.quads, grid.quads);
  EXPECT_LT(summary.energy_after, summary.energy_before);
}

TEST(QuadOptimisation, OrthogonalityPutsCornersOnCircles) {
  QuadPatch mesh = grid_patch(12, 9);
  for (Vec2& p : mesh.points) p = {p.x + 0.2 * std::sin(p.y), p.y + 0.2 * std::sin(0.7 * p.x)};
  // Sine of the sum of two opposite angles, from the sides as complex numbers.
  const auto off = [](const QuadPatch& m) {
    double sum = 0;
    for (const auto& q : m.quads) {
      std::array<Vec2, 4> s;
      for (int k = 0; k < 4; ++k) s[k] = m.points[q[(k + 1) % 4]] - m.points[q[k]];
      const double first = std::atan2(cross(s[0], -1 * s[3]), dot(s[0], -1 * s[3])),
                   third = std::atan2(cross(s[2], -1 * s[1]), dot(s[2], -1 * s[1]));
      sum += std::abs(std::sin(first + third));
    }
    return sum / static_cast<double>(m.quads.size());
  };
  const auto with = [&](double orthogonality) {
    OptimisationOptions options;
    options.orthogonality = orthogonality;
    return optimise_vertices(mesh, FunctionSize(1.2), FunctionCross(0), nullptr, {}, options);
  };
  const double usual = off(with(0));
  EXPECT_GT(usual, 0.01);
  EXPECT_LT(off(with(100)), 0.2 * usual);
}

TEST(QuadOptimisation, NeverWorseThanTheWorstBeforeNorTheFloor) {
  for (int seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(seed);
    QuadPatch mesh = jittered(scrambled(grid_patch(10, 9), seed, seed % 4), seed, 0.25);
    QuadTopology topology(mesh);
    const FunctionSize size([](Vec2 p) { return 0.5 + 0.1 * p.x; });
    QuadRelocation relocation(topology, size);
    relocation.keep_convex_corners();
    relocation.activate_all();
    relocation.relax(0.01, 20);
    mesh = topology.to_patch();
    const QuadPatch result = optimise_vertices(mesh, size, FunctionCross(0.1));
    EXPECT_EQ(result.quads, mesh.quads);
    const auto wrong = check_quad_patch(result, shapes::rectangle(10, 9, 10, 9), 1);
    EXPECT_TRUE(wrong.empty()) << wrong.front();
    EXPECT_GE(worst_sine(result), std::min(worst_sine(mesh), kFloorSine));
    const QuadPatch again = optimise_vertices(mesh, size, FunctionCross(0.1));
    EXPECT_EQ(again.points, result.points);
  }
}

TEST(QuadOptimisation, UntanglesFirst) {
  const QuadPatch mesh = jittered(grid_patch(8, 8), 5, 2);
  ASSERT_LT(worst_sine(mesh), -0.5);
  OptimisationSummary summary;
  const QuadPatch result = optimise_vertices(mesh, FunctionSize(1), FunctionCross(0), &summary);
  EXPECT_GT(summary.untangled, 0);
  EXPECT_EQ(summary.held, 0);
  EXPECT_GT(worst_sine(result), 0.98);
}

TEST(QuadOptimisation, WhatCannotBeUntangledIsHeld) {
  // A vertex between two quads only, beside a grid that is fit to move.
  QuadPatch mesh = jittered(grid_patch(6, 6), 1, 0.2);
  QuadTopology topology(mesh);
  int h = -1;
  for (int e = 0; e < topology.element_slots() && h < 0; ++e)
    for (int k = 0; k < 4 && h < 0; ++k)
      if (!topology.on_boundary(topology.origin(4 * e + k)) &&
          !topology.on_boundary(topology.target(4 * e + k)))
        h = 4 * e + k;
  for (int turn = 0; turn < 2; ++turn) {
    ASSERT_TRUE(topology.can_rotate(h, true));
    h = topology.rotate(h, true);
  }
  mesh = topology.to_patch();
  const QuadPatch result = optimise_vertices(mesh, FunctionSize(1), FunctionCross(0));
  EXPECT_GE(worst_sine(result), std::min(worst_sine(mesh), kFloorSine));
  EXPECT_NE(result.points, mesh.points);
}

TEST(QuadOptimisation, WorstQuadIsLifted) {
  // A sharp corner of the outline cannot be helped; a displaced vertex can.
  QuadPatch mesh = grid_patch(6, 6);
  mesh.points[mesh.n_boundary + 12] += Vec2{0.45, 0.4};
  OptimisationSummary summary;
  const QuadPatch result = optimise_vertices(mesh, FunctionSize(1), FunctionCross(0), &summary);
  EXPECT_GT(summary.worst_after, summary.worst_before + 0.2);
  EXPECT_NEAR(summary.worst_after, 2 / std::numbers::pi * std::asin(worst_sine(result)), 1e-12);
}

TEST(QuadOptimisation, NothingToMove) {
  const QuadPatch one = grid_patch(1, 1);
  EXPECT_EQ(optimise_vertices(one, FunctionSize(1), FunctionCross(0)).points, one.points);
  QuadPatch triangle;
  triangle.points = shapes::disk(1, 3).points;
  triangle.triangles = {{0, 1, 2}};
  triangle.n_boundary = 3;
  EXPECT_EQ(optimise_vertices(triangle, FunctionSize(1), FunctionCross(0)).triangles.size(), 1u);
}

}  // namespace
}  // namespace delquad
