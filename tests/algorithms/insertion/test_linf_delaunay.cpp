// SPDX-License-Identifier: GPL-3.0-or-later
#include "algorithms/insertion/linf_delaunay.h"
#include "tests/support/meshing.h"

namespace delquad {
namespace {

TEST(LinfDelaunay, AgreesOnTheVisibleEdgesOfFourPoints) {
  // A flat rhombus around its center: both norms join the center to all.
  const auto c = compare_linf_delaunay({{0, 0}, {2, 0.1}, {0.1, 1}, {-2, -0.1}, {-0.1, -1}});
  EXPECT_EQ(c.both.size(), 4u);
  EXPECT_TRUE(c.only_l2.empty());
  EXPECT_TRUE(c.only_linf.empty());
}

// Two triangulations of the same region differ by swaps, hence by as many edges on each side; few, as the
// paper says.
TEST(LinfDelaunay, FewEdgesDifferOnJitteredGrids) {
  std::mt19937_64 random(1);
  std::vector<Vec2> points;
  for (int i = 0; i < 30; ++i) {
    for (int j = 0; j < 30; ++j) {
      points.push_back({i + 0.6 * shapes::uniform(random), j + 0.6 * shapes::uniform(random)});
    }
  }
  const auto c = compare_linf_delaunay(points);
  EXPECT_GT(c.both.size(), 2000u);
  EXPECT_GT(c.only_l2.size(), 0u);
  EXPECT_LT(c.only_l2.size(), 0.1 * c.both.size());
}

}  // namespace
}  // namespace delquad
