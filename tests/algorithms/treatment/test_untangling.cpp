// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/relocation/untangling.h"
#include "tests/algorithms/stages.h"

namespace delquad {
namespace {

std::vector<int> interior(const QuadTopology& mesh, int n_boundary) {
  std::vector<int> vertices(mesh.vertex_slots() - n_boundary);
  std::iota(vertices.begin(), vertices.end(), n_boundary);
  return vertices;
}

TEST(Untangling, RandomPlacesInAndOutsideTheOutline) {
  for (int seed = 0; seed < 20; ++seed) {
    const QuadPatch grid = jittered(grid_patch(6, 5), seed, 4);
    QuadTopology mesh(grid);
    ASSERT_LT(worst_sine(mesh), -0.5);
    EXPECT_TRUE(untangle(mesh, interior(mesh, grid.n_boundary))) << "seed " << seed;
    EXPECT_GT(worst_sine(mesh), 0) << "seed " << seed;
    for (int v = 0; v < grid.n_boundary; ++v) EXPECT_EQ(mesh.point(v), grid.points[v]);
  }
}

TEST(Untangling, ArrowWhoseMiddleLiesOutside) {
  // A corner of a gap a tenth as wide as its sides: the new vertices start outside.
  QuadPatch arrow;
  arrow.points = {{0, 0}, {1, 0}, {0.1, 0.1}, {0, 1}};
  arrow.quads = {{0, 1, 2, 3}};
  arrow.n_boundary = 4;
  QuadTopology mesh(arrow);
  ASSERT_LT(worst_sine(mesh), 0);
  mesh.pillow(std::array<int, 1>{0});
  ASSERT_LT(worst_sine(mesh), 0);
  EXPECT_TRUE(untangle(mesh, interior(mesh, 4)));
  EXPECT_GT(worst_sine(mesh), 0.01);
}

TEST(Untangling, OnlyTheGivenVerticesMove) {
  QuadPatch grid = grid_patch(5, 5);
  const int v = grid.n_boundary + 5;  // with four interior neighbors
  grid.points[v] = {4.5, 4.5};
  QuadTopology mesh(grid);
  EXPECT_TRUE(untangle(mesh, std::array<int, 1>{v}));
  EXPECT_GT(worst_sine(mesh), 0);
  for (int w = 0; w < mesh.vertex_slots(); ++w) {
    const Vec2 expected = w == v ? mesh.point(w) : grid.points[w];
    EXPECT_EQ(mesh.point(w), expected);
  }
}

TEST(Untangling, WhatIsSoundStays) {
  const QuadPatch grid = jittered(grid_patch(5, 4), 3, 0.2);
  QuadTopology mesh(grid);
  ASSERT_GT(worst_sine(mesh), 0);
  EXPECT_TRUE(untangle(mesh, interior(mesh, grid.n_boundary)));
  EXPECT_EQ(mesh.to_patch().points, grid.points);
}

TEST(Untangling, SaysWhenItCannot) {
  // A vertex between two quads only has an angle of 180 degrees or more.
  QuadPatch doublet;
  doublet.points = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0.5, 0.6}};
  doublet.quads = {{0, 1, 2, 4}, {0, 4, 2, 3}};
  doublet.n_boundary = 4;
  QuadTopology mesh(doublet);
  EXPECT_FALSE(untangle(mesh, std::array<int, 1>{4}));
  EXPECT_GE(mesh.point(4).x, 0);
  EXPECT_LE(mesh.point(4).x, 1);
  EXPECT_FALSE(untangle(mesh, {}));
}

}  // namespace
}  // namespace delquad
