// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/relocation/quad_relocation.h"
#include "smoothing/relocation/untangling.h"
#include "tests/support/meshing.h"
#include "tests/support/quad_patches.h"

namespace delquad {
namespace {

TEST(ShortEdges, AreOpened) {
  QuadPatch mesh = grid_patch(6, 6);
  const int v = mesh.n_boundary + 7;  // its right neighbor comes next
  for (const double length : {0.0, 1e-16, 1e-5}) {
    mesh.points[v] = mesh.points[v + 1] + Vec2{-length, 0};
    QuadTopology topology(mesh);
    EXPECT_EQ(lengthen_short_edges(topology, FunctionSize(1)), 1);
    EXPECT_GT(norm(topology.point(v) - topology.point(v + 1)), 0.2);
    for (int e = 0; e < topology.element_slots(); ++e) EXPECT_GT(least_sine(topology, e), 0.5);
  }
}

TEST(ShortEdges, OthersStay) {
  const QuadPatch mesh = jittered(grid_patch(6, 6), 1, 0.3);
  QuadTopology topology(mesh);
  EXPECT_EQ(lengthen_short_edges(topology, FunctionSize(1)), 0);
  EXPECT_EQ(topology.to_patch().points, mesh.points);
}

TEST(ShortEdges, BoundaryStays) {
  QuadPatch mesh = grid_patch(3, 3);
  mesh.points[mesh.n_boundary] = mesh.points[1];  // on the bottom side
  QuadTopology topology(mesh);
  EXPECT_EQ(lengthen_short_edges(topology, FunctionSize(1)), 1);
  EXPECT_EQ(topology.point(1), mesh.points[1]);
  EXPECT_GT(norm(topology.point(mesh.n_boundary) - mesh.points[1]), 0.2);
}

}  // namespace
}  // namespace delquad
