// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/mesh/quad_blocks.h"
#include "tests/support/meshing.h"
#include "tests/support/quad_patches.h"

namespace delquad {
namespace {

/// The corners' places of each quad, its least first, sorted: the same for every numbering.
std::vector<std::array<double, 8>> shapes_of(const QuadPatch& mesh) {
  std::vector<std::array<double, 8>> shapes;
  for (auto quad : mesh.quads) {
    const auto before = [&](int a, int b) {
      const Vec2 p = mesh.points[a], q = mesh.points[b];
      return p.x != q.x ? p.x < q.x : p.y < q.y;
    };
    std::ranges::rotate(quad, std::ranges::min_element(quad, before));
    auto& shape = shapes.emplace_back();
    for (int k = 0; k < 4; ++k)
      shape[2 * k] = mesh.points[quad[k]].x, shape[2 * k + 1] = mesh.points[quad[k]].y;
  }
  std::ranges::sort(shapes);
  return shapes;
}

/// More than four blocks.
QuadPatch large_grid() { return jittered(grid_patch(300, 290), 1, 0.2); }

TEST(QuadBlocks, SmallMeshIsOneBlockAsItIs) {
  const QuadPatch grid = grid_patch(150, 200);
  QuadBlocks whole(grid);
  std::vector<QuadBlock> blocks = whole.next();
  ASSERT_EQ(blocks.size(), 1u);
  EXPECT_EQ(blocks[0].mesh.quads, grid.quads);
  EXPECT_EQ(blocks[0].first_held, grid.n_boundary);
  EXPECT_TRUE(blocks[0].is_near(0));
  whole.put_back(std::move(blocks));
  EXPECT_TRUE(whole.next().empty());
  EXPECT_EQ(whole.take().quads, grid.quads);
}

TEST(QuadBlocks, BlocksAreSoundAndMakeUpTheMesh) {
  const QuadPatch grid = large_grid();
  QuadBlocks whole(grid);
  std::vector<QuadBlock> blocks = whole.next();
  EXPECT_GE(blocks.size(), 4u);
  std::size_t quads = 0;
  for (const QuadBlock& block : blocks) {
    const QuadTopology topology(block.mesh, block.first_held);
    EXPECT_TRUE(check_invariants(topology).empty());
    quads += block.mesh.quads.size();
    EXPECT_LT(block.mesh.quads.size(), 2u * ElementBlocks::kBlockElements);
    for (std::size_t i = 0; i < block.whole.size(); ++i)
      EXPECT_EQ(block.mesh.points[i], grid.points[block.whole[i]]);
  }
  EXPECT_EQ(quads, grid.quads.size());
  whole.put_back(std::move(blocks));
  const QuadPatch again = whole.take();
  EXPECT_EQ(shapes_of(again), shapes_of(grid));
  EXPECT_TRUE(std::equal(grid.points.begin(), grid.points.begin() + grid.n_boundary, again.points.begin()));
  EXPECT_TRUE(check_invariants(QuadTopology(again)).empty());
}

/// Each vertex inside is moved when it is met first: none may stay.
TEST(QuadBlocks, EveryPlaceIsWorkedOn) {
  QuadBlocks whole(large_grid());
  std::vector<int> passes;
  for (auto blocks = whole.next(); !blocks.empty(); blocks = whole.next()) {
    int moved = 0;
    for (QuadBlock& block : blocks)
      for (std::size_t v = block.mesh.n_boundary; v < block.mesh.points.size(); ++v)
        if (block.is_near(static_cast<int>(v)) && block.mesh.points[v].x > 0)
          block.mesh.points[v] = block.mesh.points[v] - Vec2{1000, 0}, ++moved;
    passes.push_back(moved);
    whole.put_back(std::move(blocks));
  }
  EXPECT_GE(passes.size(), 2u);
  EXPECT_GT(passes[0], 9 * passes[1]);
  EXPECT_GT(passes[1], 0);
  const QuadPatch mesh = whole.take();
  for (std::size_t v = mesh.n_boundary; v < mesh.points.size(); ++v) EXPECT_LT(mesh.points[v].x, 0) << v;
}

TEST(QuadBlocks, AHeldVertexHasAPointForEachFan) {
  // Four blocks meet at few points only. Fans of one block on both sides of a vertex are rarer still, so all
  // vertices are counted. Corners of a block around a held point are one fan.
  QuadBlocks whole(large_grid());
  for (const QuadBlock& block : whole.next()) {
    const QuadTopology topology(block.mesh, block.first_held);
    std::vector<int> corners(block.mesh.points.size(), 0);
    for (const auto& quad : block.mesh.quads)
      for (const int v : quad) ++corners[v];
    for (int v = 0; v < block.mesh.n_boundary; ++v) {
      int fan = 0;
      topology.for_each_out(v, [&](int) { ++fan; });
      EXPECT_EQ(fan, corners[v]);
      EXPECT_EQ(topology.held(v), v >= block.first_held);
    }
  }
}

TEST(QuadBlocks, CornersThatAreNoPointsAreLeftToOthers) {
  QuadPatch grid = large_grid();
  grid.quads[7][2] = static_cast<int>(grid.points.size());
  QuadBlocks whole(grid);
  std::vector<QuadBlock> blocks = whole.next();
  ASSERT_EQ(blocks.size(), 1u);
  EXPECT_EQ(blocks[0].mesh.quads, grid.quads);
}

}  // namespace
}  // namespace delquad
