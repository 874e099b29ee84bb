// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/meshing.h"

namespace delquad {
namespace {

/// A strip of n by m squares whose nodes are numbered at random.
Mesh shuffled_grid(int n, int m) {
  std::vector<int> number((n + 1) * (m + 1));
  for (std::size_t i = 0; i < number.size(); ++i) number[i] = static_cast<int>(i);
  std::shuffle(number.begin(), number.end(), std::mt19937(5));
  Mesh mesh;
  mesh.points.resize(number.size());
  const auto at = [&](int i, int j) { return number[j * (n + 1) + i]; };
  for (int j = 0; j <= m; ++j)
    for (int i = 0; i <= n; ++i) mesh.points[at(i, j)] = {1.0 * i, 1.0 * j, 0};
  for (int j = 0; j < m; ++j)
    for (int i = 0; i < n; ++i) {
      mesh.quads.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
      mesh.quad_region.push_back(0);
    }
  for (int i = 0; i < n; ++i) {
    mesh.lines.push_back({at(i, 0), at(i + 1, 0)});
    mesh.line_curve.push_back(0);
  }
  mesh.curves = {{1, {"side"}}};
  mesh.regions = {{1, {}}};
  mesh.named_points = {{at(n, m), {1, {"corner"}}}};
  return mesh;
}

TEST(ReduceBandwidth, NumbersAStripAcrossItsWidth) {
  Mesh mesh = shuffled_grid(60, 4);
  const Mesh before = mesh;
  EXPECT_GT(bandwidth(before), 200);
  reduce_bandwidth(mesh);
  // Five nodes across: the next column is five on, and one more for the diagonal; the order may lean.
  EXPECT_LE(bandwidth(mesh), 10);
  EXPECT_TRUE(check_invariants(mesh).empty());
  for (std::size_t q = 0; q < mesh.quads.size(); ++q)
    for (int k = 0; k < 4; ++k) EXPECT_EQ(mesh.points[mesh.quads[q][k]], before.points[before.quads[q][k]]);
  for (std::size_t l = 0; l < mesh.lines.size(); ++l)
    EXPECT_EQ(mesh.points[mesh.lines[l][0]], before.points[before.lines[l][0]]);
  EXPECT_EQ(mesh.points[mesh.named_points[0].point], (Vec3{60, 4, 0}));
}

TEST(ReduceBandwidth, LeavesAGoodOrderAlone) {
  Mesh mesh = shuffled_grid(60, 4);
  reduce_bandwidth(mesh);
  const Mesh once = mesh;
  reduce_bandwidth(mesh);
  EXPECT_LE(bandwidth(mesh), bandwidth(once));
  Mesh nothing;
  reduce_bandwidth(nothing);
  EXPECT_EQ(bandwidth(nothing), 0);
}

}  // namespace
}  // namespace delquad
