// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/report/page_json.h"
#include "metrics/metrics.h"
#include "tests/support/files.h"

namespace delquad {
namespace {

/// Squares, of which those around two vertices are spoilt, the second less.
Mesh spoilt_grid() {
  Mesh mesh = quad_grid(12, 12, 12, 12);
  mesh.points[3 * 13 + 3].x += 0.5;
  mesh.points[9 * 13 + 9].y += 0.3;
  return mesh;
}

TEST(Closeup, ShowsTheWorstFirstAndNoneTwice) {
  const Mesh mesh = spoilt_grid();
  const std::vector<Closeup> closeups = worst_quads(mesh, 2);
  ASSERT_EQ(closeups.size(), 2u);
  EXPECT_NEAR(closeups[0].at.x, 3, 1);
  EXPECT_NEAR(closeups[0].at.y, 3, 1);
  EXPECT_NEAR(closeups[1].at.x, 9, 1);
  EXPECT_NEAR(closeups[1].at.y, 9, 1);
  const std::vector<double> eta = quad_etas(mesh);
  EXPECT_EQ(closeups[0].eta, *std::min_element(eta.begin(), eta.end()));
  EXPECT_LT(closeups[0].eta, closeups[1].eta);
}

TEST(Closeup, HasThreeRingsAroundTheQuad) {
  const Closeup closeup = worst_quads(spoilt_grid(), 1)[0];
  EXPECT_EQ(closeup.elements.size(), 36u);  // 7 x 7, cut at two sides of the grid
  EXPECT_EQ(closeup.etas[0], closeup.eta);
  EXPECT_EQ(closeup.elements[0].size(), 4u);
  EXPECT_EQ(closeup.points.size(), 49u);
  Vec2 centre;
  for (const int v : closeup.elements[0]) centre += 0.25 * closeup.points[v];
  EXPECT_NEAR(norm(centre), 0, 1e-12);
}

/// The same quads stood upright, seen from their front, look the same.
TEST(Closeup, LooksAtSurfacesFromTheFront) {
  Mesh flat = spoilt_grid(), upright = flat;
  for (Vec3& p : upright.points) p = {p.x, 0, p.y};
  const Closeup a = worst_quads(flat, 1)[0], b = worst_quads(upright, 1)[0];
  ASSERT_EQ(a.points.size(), b.points.size());
  for (std::size_t i = 0; i < a.points.size(); ++i) EXPECT_NEAR(norm(a.points[i] - b.points[i]), 0, 1e-12);
  EXPECT_NEAR(b.normal.y, -1, 1e-12);
}

TEST(Closeup, NothingOfTriangles) { EXPECT_TRUE(worst_quads(triangle_grid(3, 3), 3).empty()); }

TEST(Closeup, NeighboursCountOnce) {
  Mesh mesh = quad_grid(2, 2);
  mesh.points[4].x += 0.1;  // spoils all four, which share it
  EXPECT_EQ(worst_quads(mesh, 3).size(), 1u);
}

}  // namespace
}  // namespace delquad
