// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/mesh/check_invariants.h"
#include "tests/support/meshing.h"

namespace delquad {
namespace {

using Report = std::vector<std::string>;

/// There is one complaint only, and it holds the text.
void expect_one(const Mesh& mesh, const std::string& text) {
  const Report wrong = check_invariants(mesh);
  ASSERT_EQ(wrong.size(), 1u) << ::testing::PrintToString(wrong);
  EXPECT_TRUE(holds(wrong[0], text));
}

/// Some complaint holds the text.
void expect_some(const Mesh& mesh, const std::string& text) {
  const Report wrong = check_invariants(mesh);
  const auto has_text = [&](const std::string& line) { return bool(holds(line, text)); };
  EXPECT_TRUE(std::any_of(wrong.begin(), wrong.end(), has_text)) << ::testing::PrintToString(wrong);
}

TEST(MeshInvariants, HoldForSoundMeshes) {
  EXPECT_EQ(check_invariants(Mesh{}), Report());
  EXPECT_EQ(check_invariants(quad_grid(4, 3)), Report());
  EXPECT_EQ(check_invariants(triangle_grid(4, 3)), Report());
  EXPECT_EQ(check_invariants(grid_outline(1, 1, 1, 1)), Report()) << "lines alone";
}

TEST(MeshInvariants, IndicesAreInRange) {
  Mesh mesh = quad_grid(2, 2);
  mesh.quads[1][2] = 9;
  expect_one(mesh, "quad 1: vertex 9 is out of range (0 to 8)");
  mesh = triangle_grid(2, 2);
  mesh.triangles[3][0] = -1;
  expect_one(mesh, "triangle 3: vertex -1");
  mesh = quad_grid(2, 2);
  mesh.line_curve[5] = 4;
  expect_one(mesh, "line 5: entity 4 is out of range");
  mesh = quad_grid(2, 2);
  mesh.quad_region.pop_back();
  expect_one(mesh, "quads: 4 elements but 3 entity indices");
}

TEST(MeshInvariants, ElementsAreDistinctAndHaveDistinctVertices) {
  Mesh mesh = quad_grid(2, 2);
  mesh.quads[0] = {0, 1, 4, 4};
  expect_some(mesh, "quad 0: a vertex is repeated");
  mesh = quad_grid(2, 2);
  mesh.quads.push_back({4, 3, 0, 1});
  mesh.quad_region.push_back(0);
  expect_some(mesh, "two quads on the vertices 0, 1, 3, 4");
  mesh = quad_grid(2, 2);
  mesh.lines.push_back({1, 0});
  mesh.line_curve.push_back(0);
  expect_one(mesh, "two lines on the vertices 0, 1");
}

TEST(MeshInvariants, NeighboursRunAlongTheirEdgeInOppositeDirections) {
  Mesh mesh = quad_grid(2, 1);
  std::swap(mesh.quads[0][1], mesh.quads[0][3]);
  expect_one(mesh, "edge 1, 4: elements 0 and 1 run along it the same way");
}

TEST(MeshInvariants, EdgesHaveTwoElementsAtMost) {
  Mesh mesh = quad_grid(2, 1);
  mesh.points.push_back({0, 0, 1});
  mesh.triangles.push_back({1, 4, 6});
  mesh.triangle_region.push_back(0);
  expect_one(mesh, "edge 1, 4: in 3 elements");
}

TEST(MeshInvariants, LinesAreEdges) {
  Mesh mesh = quad_grid(2, 2);
  for (const std::array<int, 2> line :
       {std::array{0, 4}, std::array{8, 7}, std::array{8, 2}, std::array{6, 8}}) {
    mesh.lines.push_back(line);
    mesh.line_curve.push_back(0);
  }
  const Report wrong = check_invariants(mesh);
  EXPECT_EQ(wrong,
            (Report{"two lines on the vertices 7, 8", "line 0, 4: not an edge of any element",
                    "line 2, 8: not an edge of any element", "line 6, 8: not an edge of any element"}));
}

TEST(MeshInvariants, EveryVertexIsUsed) {
  Mesh mesh = quad_grid(2, 2);
  mesh.points.push_back({5, 5, 0});
  expect_one(mesh, "vertex 9: nothing uses it");
}

TEST(MeshInvariants, EntityTagsArePositiveAndDistinct) {
  Mesh mesh = quad_grid(2, 2);
  mesh.curves[1].tag = 1;
  expect_one(mesh, "curve tag 1: used twice");
  mesh = quad_grid(2, 2);
  mesh.regions[0].tag = 0;
  expect_one(mesh, "region tag 0: not positive");
}

TEST(MeshInvariants, MarkedCurvesMayBranch) {
  Mesh mesh = quad_grid(1, 1);
  const int a = mesh.lines[0][0], b = mesh.lines[0][1];
  for (const double z : {1.0, 2.0}) {
    mesh.points.push_back({0.5, 0, z});
    mesh.triangles.push_back({a, b, static_cast<int>(mesh.points.size()) - 1});
    mesh.triangle_region.push_back(0);
  }
  expect_some(mesh, "in 3 elements");
  std::vector<char> branching(mesh.curves.size(), 0);
  branching[mesh.line_curve[0]] = 1;
  EXPECT_EQ(check_invariants(mesh, branching), Report());
  branching[mesh.line_curve[0]] = 0;
  EXPECT_NE(check_invariants(mesh, branching), Report());
}

}  // namespace
}  // namespace delquad
