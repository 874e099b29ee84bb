// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/surface/surface_editor.h"
#include "tests/support/flat_patch_checks.h"
#include "tests/support/meshing.h"

namespace delquad {
namespace {

// Three squares that share the side from node 0 to node 1.
SurfaceModel book() {
  SurfaceModel model;
  model.fine.points = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}};
  model.fine.triangles = {{0, 1, 2}, {0, 1, 3}, {1, 0, 4}};
  model.fine.triangle_region = {0, 1, 2};
  model.fine.regions = {{1, {}}, {2, {}}, {3, {}}};
  model.fine.lines = {{0, 1}, {1, 2}};
  model.fine.line_curve = {0, 1};
  model.fine.curves = {{4, {}}, {9, {}}};
  return model;
}

TEST(SurfaceEditor, SplitsAllTrianglesOfASide) {
  SurfaceModel model = book();
  SurfaceEditor editor(model);
  const int node = editor.split_edge(1, 0, {0, 0, 0.25});
  const int other = editor.split_edge(0, node, {0, 0, 0.125});
  editor.finish();
  EXPECT_EQ(model.fine.triangles.size(), 9u);
  const std::vector<std::array<int, 2>> lines = {{0, other}, {other, node}, {node, 1}, {1, 2}};
  EXPECT_EQ(model.fine.lines, lines);
  EXPECT_EQ(model.fine.line_curve, (std::vector<int>{0, 0, 0, 1}));
  EXPECT_EQ(editor.triangles_on(0, 1).size(), 0u);
  EXPECT_EQ(editor.triangles_on(other, node).size(), 3u);
  for (const auto& v : model.fine.triangles) {
    const auto& p = model.fine.points;
    EXPECT_GT(norm(cross(p[v[1]] - p[v[0]], p[v[2]] - p[v[0]])), 0.05);
  }
}

TEST(SurfaceEditor, FlipsOnlyInnerEdges) {
  SurfaceModel model = grid_surface({1, 1}, [](double u, double v) { return Vec3{u, v, 0}; });
  SurfaceEditor editor(model);
  const auto diagonal = [&] {
    for (int a = 0; a < 4; ++a)
      for (int b = a + 1; b < 4; ++b)
        if (editor.triangles_on(a, b).size() == 2) return std::pair(a, b);
    return std::pair(-1, -1);
  };
  const auto before = diagonal();
  EXPECT_FALSE(editor.flip_edge(model.fine.lines[0][0], model.fine.lines[0][1]));
  ASSERT_TRUE(editor.flip_edge(before.first, before.second));
  EXPECT_NE(diagonal(), before);
  editor.finish();
  EXPECT_TRUE(check_invariants(model.fine).empty());
}

// In a tetrahedron each diagonal is an edge already.
TEST(SurfaceEditor, KeepsTheSurfaceAManifold) {
  SurfaceModel model =
      one_face({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}});
  SurfaceEditor editor(model);
  EXPECT_FALSE(editor.flip_edge(0, 1));
}

TEST(SurfaceEditor, AddsCurves) {
  SurfaceModel model = book();
  SurfaceEditor editor(model);
  EXPECT_EQ(editor.add_curve(std::vector{2, 0, 3}), 2);
  editor.finish();
  EXPECT_EQ(model.fine.curves.back().tag, 10);
  EXPECT_EQ(model.fine.line_curve, (std::vector<int>{0, 1, 2, 2}));
}

}  // namespace
}  // namespace delquad
