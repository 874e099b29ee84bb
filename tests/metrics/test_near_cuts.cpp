// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrics/surface/surface_report.h"
#include "tests/support/files.h"

namespace delquad {
namespace {

/// 8 x 8 quads with a cut from south to north through the middle; its curve is the last.
Mesh grid_with_cut() {
  Mesh mesh = quad_grid(8, 8);
  mesh.curves.push_back({99, {}});
  const int curve = static_cast<int>(mesh.curves.size()) - 1;
  for (int j = 0; j < 8; ++j) {
    mesh.lines.push_back({4 + 9 * j, 4 + 9 * (j + 1)});
    mesh.line_curve.push_back(curve);
  }
  return mesh;
}

std::vector<char> last_is_cut(const Mesh& mesh) {
  std::vector<char> is_cut(mesh.curves.size(), 0);
  is_cut.back() = 1;
  return is_cut;
}

TEST(NearCuts, ThreeRingsOnBothSides) {
  const Mesh mesh = grid_with_cut();
  QuadShare near, off;
  measure_near_cuts(mesh, last_is_cut(mesh), near, off);
  EXPECT_EQ(near.quads, 6 * 8);
  EXPECT_EQ(off.quads, 2 * 8);
  EXPECT_EQ(near.vertices, 5 * 7) << "those inside";
  EXPECT_EQ(off.vertices, 2 * 7);
  for (const QuadShare& share : {near, off}) {
    EXPECT_NEAR(share.eta, 1, 1e-12);
    EXPECT_EQ(share.d4, 100);
  }
}

TEST(NearCuts, TellApartWhereQuadsAreWorse) {
  Mesh mesh = grid_with_cut();
  mesh.points[4 + 9 * 4].x += 0.05;
  QuadShare near, off;
  measure_near_cuts(mesh, last_is_cut(mesh), near, off);
  EXPECT_LT(near.eta, 0.99);
  EXPECT_NEAR(off.eta, 1, 1e-12);
}

TEST(NearCuts, NothingWithoutCuts) {
  const Mesh mesh = grid_with_cut();
  QuadShare near, off;
  measure_near_cuts(mesh, std::vector<char>(mesh.curves.size(), 0), near, off);
  EXPECT_EQ(near.quads + off.quads, 0);
}

}  // namespace
}  // namespace delquad
