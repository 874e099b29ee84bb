// SPDX-License-Identifier: GPL-3.0-or-later
#include "algorithms/recombination/dual_graph.h"
#include "tests/algorithms/stages.h"

/// Boundaries that leave quads of eta 0 after matching: the treatment leaves none.
namespace delquad {
namespace {

double worst_eta(const QuadPatch& mesh) {
  double worst = 1;
  for (const auto& q : mesh.quads)
    worst = std::min(worst,
                     signed_eta(mesh.points[q[0]], mesh.points[q[1]], mesh.points[q[2]], mesh.points[q[3]]));
  return worst;
}

/// eta worst after the treatment, of a case in which matching alone leaves quads of eta 0.
double repaired(const PatchBoundary& boundary, double size) {
  const FunctionSize delta(size);
  const QuadPatch raw = matched(boundary, delta, FunctionCross(0));
  EXPECT_LE(worst_eta(raw), 1e-12);
  const QuadPatch mesh = treat_paper(raw, delta);
  expect_sound(mesh, boundary);
  EXPECT_TRUE(mesh.triangles.empty());
  return worst_eta(mesh);
}

TEST(BadQuads, CornersOfGapsThinnerThanTheSize) {
  for (const double gap : {0.02, 0.01, 0.005}) {
    PatchBoundary boundary = shapes::rectangle(2, 2, 20, 20);
    const double a = gap, b = 1.3;
    shapes::add_polygon(boundary, {{a, a}, {a, b}, {b, b}, {b, a}}, {13, 13, 13, 13});
    // The angles in the gap are about gap / size.
    EXPECT_GT(repaired(boundary, 0.1), gap) << "gap " << gap;
  }
}

TEST(BadQuads, TipsOfThinWedges) {
  for (const double degrees : {1, 5}) {
    const double angle = degrees * std::numbers::pi / 180;
    PatchBoundary boundary;
    shapes::add_polygon(boundary, {{0, 0}, {1, 0}, {std::cos(angle), std::sin(angle)}}, {10, 2, 10});
    // The tip's own angle allows degrees / 90; two quads there have half of it.
    EXPECT_GT(repaired(boundary, 0.1), 0.4 * degrees / 90) << degrees << " degrees";
  }
}

TEST(BadQuads, FourPointsOfWhichThreeLieInLine) {
  EXPECT_GT(repaired(shapes::polygon({{0, 0}, {1, 0}, {2, 0}, {1, 1.5}}), 1), 0.2);
  // A row of such quads in a comb, whose teeth are as wide as two edges.
  std::vector<Vec2> corners = {{0, 0}, {4, 0}, {8, 0}};
  for (int i = 8; i > 0; i -= 2) corners.insert(corners.end(), {{double(i), 1}, {i - 1.0, 3}});
  corners.push_back({0, 1});
  EXPECT_GT(repaired(shapes::polygon(corners), 1), 0.02);
}

TEST(BadQuads, StarOfSharpTips) {
  std::vector<Vec2> corners;
  for (int i = 0; i < 24; ++i) {
    const double t = std::numbers::pi * i / 12, r = i % 2 == 0 ? 1 : 0.1;
    corners.push_back(r * Vec2{std::cos(t), std::sin(t)});
  }
  EXPECT_GT(repaired(shapes::polygon(corners, 9), 0.1), 0.01);
}

TEST(BadQuads, BoundaryMuchCoarserThanTheSize) {
  for (const auto& [per_side, size] : {std::pair{1, 0.03}, {2, 0.02}})
    EXPECT_GT(repaired(shapes::rectangle(1, 1, per_side, per_side), size), 0) << per_side << ", " << size;
}

TEST(BadQuads, BoundaryMuchFinerThanTheSize) {
  for (int seed = 0; seed < 10; ++seed) {
    const PatchBoundary boundary = shapes::random_polygon_with_holes(seed, 0.04);
    EXPECT_GT(repaired(boundary, 0.3), 0) << "seed " << seed;
  }
}

}  // namespace
}  // namespace delquad
