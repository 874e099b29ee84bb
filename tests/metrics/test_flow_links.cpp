// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrics/flow_links.h"
#include "tests/support/files.h"

namespace delquad {
namespace {

TEST(FlowLinks, OfQuadsInCirclesAreOrthogonal) {
  // Rings of trapezoids, each of which has a circle through its corners.
  Mesh mesh = quad_grid(24, 5, 6, 2);
  for (Vec3& p : mesh.points) p = {(3 + p.y) * std::cos(p.x / 2), (3 + p.y) * std::sin(p.x / 2), 0};
  for (auto& quad : mesh.quads) std::swap(quad[1], quad[3]);
  const FlowLinks links = measure_flow_links(mesh);
  EXPECT_EQ(links.links, 23 * 5 + 24 * 4);
  EXPECT_LT(links.cos_max, 1e-5);  // after a hundred steps
  EXPECT_EQ(links.orthogonal, links.links);
  EXPECT_EQ(links.small, 0);
}

TEST(FlowLinks, HaveTheAngleOfMeansWhereOneEdgeIsInside) {
  Mesh mesh = quad_grid(2, 1, 2, 1);
  mesh.points[4].x = 1.5;  // means (0.625, 0.5) and (1.625, 0.5), edge (0.5, 1), areas 1.25 and 0.75
  const FlowLinks links = measure_flow_links(mesh);
  EXPECT_EQ(links.links, 1);
  EXPECT_NEAR(links.cos_max, 0.5 / std::sqrt(1.25), 1e-14);
  EXPECT_NEAR(links.cos_mean, links.cos_max, 1e-14);
  EXPECT_EQ(links.worst.at, (Vec3{1.25, 0.5, 0}));
  EXPECT_NEAR(links.least_ratio, 2 / (std::sqrt(1.25) + std::sqrt(0.75)), 1e-14);
}

TEST(FlowLinks, OfHalvesOfASquareAreSmall) {
  const FlowLinks links = measure_flow_links(triangle_grid(2, 2));
  EXPECT_EQ(links.links, 8);
  EXPECT_EQ(links.small, 4);  // across the diagonals, where both circles are one
  EXPECT_EQ(links.least_ratio, 0);
  EXPECT_EQ(links.cos_max, 0);
}

TEST(FlowLinks, OfBluntTrianglesEndAtTheirEdges) {
  Mesh mesh = triangle_grid(1, 1, 2, 1);
  mesh.points = {{0, 0, 0}, {4, 0, 0}, {1, 1, 0}, {2, -1, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 3, 1}};
  mesh.lines.clear(), mesh.line_curve.clear();
  // The first circle has its center in (2, -1), the second in (2, 1.5). Both go back to the edge, the first
  // on the way from (5/3, 1/3), a fourth of it.
  const FlowLinks links = measure_flow_links(mesh);
  EXPECT_EQ(links.links, 1);
  EXPECT_NEAR(links.least_ratio, (2 - (5.0 / 3 + 1.0 / 12)) / std::sqrt(2), 1e-14);
  EXPECT_NEAR(links.cos_max, 1, 1e-14);
  EXPECT_EQ(links.oblique, 1);
  EXPECT_EQ(links.orthogonal, 0);
}

}  // namespace
}  // namespace delquad
