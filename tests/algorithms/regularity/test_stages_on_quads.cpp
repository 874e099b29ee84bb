// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/algorithms/stages.h"

namespace delquad {
namespace {

/// Treatment, clean-up and regularity have these tests in common.
class StageOnQuads : public testing::TestWithParam<char> {
 protected:
  QuadPatch run(const QuadPatch& mesh, const PatchBoundary& boundary, const ParametricSize& size) const {
    if (GetParam() == 'B') return treated(mesh, boundary, size);
    return GetParam() == 'C' ? cleaned(mesh, boundary, size) : regular(mesh, boundary, size);
  }
};
INSTANTIATE_TEST_SUITE_P(All, StageOnQuads, testing::Values('B', 'C', 'Q'));

TEST_P(StageOnQuads, RegularGridStays) {
  const QuadPatch grid = grid_patch(7, 5);
  expect_same(run(grid, shapes::rectangle(7, 5, 7, 5), FunctionSize(1)), grid);
}

TEST_P(StageOnQuads, SmallestMeshes) {
  const FunctionSize size(1);
  EXPECT_EQ(run(grid_patch(1, 1), shapes::rectangle(1, 1, 1, 1), size).quads.size(), 1u);
  EXPECT_EQ(run(grid_patch(2, 1), shapes::rectangle(2, 1, 2, 1), size).quads.size(), 2u);
  EXPECT_EQ(run(triangle_patch(), shapes::disk(1, 3), size).triangles.size(), 1u);
  // Nothing better than a doublet has the same boundary.
  EXPECT_EQ(run(doublet(), shapes::rectangle(2, 2, 1, 1), FunctionSize(2)).quads.size(), 1u);
}

TEST_P(StageOnQuads, OddBoundaryKeepsItsTriangle) {
  const PatchBoundary boundary = shapes::disk(1, 31);
  const FunctionSize size(0.2);
  for (const double angle : {0.0, 0.3}) {
    QuadPatch mesh = matched(boundary, size, FunctionCross(angle));
    if (GetParam() != 'B') mesh = treat_paper(mesh, size);
    ASSERT_EQ(mesh.triangles.size(), 1u);
    EXPECT_GT(worst_sine(run(mesh, boundary, size)), 0);
  }
}

}  // namespace
}  // namespace delquad
