// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/mesh/weld.h"
#include "tests/support/meshing.h"

namespace delquad {
namespace {

/// A square of two triangles that share no point, `gap` apart along the diagonal.
Mesh torn_square(double gap) {
  Mesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, gap, 0}, {1, 1 + gap, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
  mesh.triangle_region = {0, 0};
  mesh.lines = {{0, 1}, {3, 4}};
  mesh.line_curve = {0, 0};
  mesh.curves = mesh.regions = {{1, {}}};
  return mesh;
}

TEST(Weld, EqualPointsGoByTheFirst) {
  EXPECT_EQ(names_of_equal_points(torn_square(0)), (PointNames{0, 1, 2, 0, 2, 5}));
  EXPECT_EQ(names_of_equal_points(torn_square(-0.0)), (PointNames{0, 1, 2, 0, 2, 5}));
  EXPECT_EQ(names_of_equal_points(torn_square(1e-300)), (PointNames{0, 1, 2, 3, 2, 5}));
}

TEST(Weld, OpenEdgesCloseWithinTheTolerance) {
  const Mesh mesh = torn_square(1e-3);
  EXPECT_EQ(names_at_open_edges(mesh, 1.1e-3), (PointNames{0, 1, 2, 0, 2, 5}));
  EXPECT_EQ(names_at_open_edges(mesh, 0.9e-3), (PointNames{0, 1, 2, 3, 4, 5}));
  EXPECT_EQ(names_at_open_edges(mesh, 0), (PointNames{0, 1, 2, 3, 4, 5}));
}

TEST(Weld, TheNearestOfThoseThatStayIsTaken) {
  Mesh mesh;
  for (const double x : {0.0, 0.9, 1.8, 2.6, 2.0}) mesh.points.push_back({x, 0, 0});
  mesh.triangles = {{0, 2, 4}, {1, 3, 0}};
  // 1 goes to 0, so that it is not there for 2; 3 and 4 go to 2.
  EXPECT_EQ(names_at_open_edges(mesh, 1), (PointNames{0, 0, 2, 2, 2}));
}

TEST(Weld, PointsInsideStayApart) {
  // Two closed tetrahedra back to back: all edges have two triangles.
  Mesh mesh;
  for (int k = 0; k < 2; ++k) {
    const int n = 4 * k;
    mesh.points.insert(mesh.points.end(), {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, k == 0 ? 1.0 : -1.0}});
    mesh.triangles.insert(mesh.triangles.end(),
                          {{n, n + 2, n + 1}, {n, n + 1, n + 3}, {n, n + 3, n + 2}, {n + 1, n + 2, n + 3}});
  }
  EXPECT_EQ(names_at_open_edges(mesh, 0.1), (PointNames{0, 1, 2, 3, 4, 5, 6, 7}));
  EXPECT_EQ(names_of_equal_points(mesh), (PointNames{0, 1, 2, 3, 0, 1, 2, 7}));
}

TEST(Weld, EndsOfOpenEdgesGoByPointsInside) {
  // The tip of a triangle stands on the middle of a square.
  Mesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 1}, {-1, 0, 1}, {1, 1, 0}, {-1, 1, 0}, {-1, -1, 0}, {1, -1, 0}, {0, 0, 0}};
  mesh.triangles = {{0, 1, 2}, {3, 4, 7}, {4, 5, 7}, {5, 6, 7}, {6, 3, 7}};
  EXPECT_EQ(names_at_open_edges(mesh, 0.1), (PointNames{7, 1, 2, 3, 4, 5, 6, 7}));
  mesh.points[3] = {0.01, 0.01, 0};  // a side joins it to the middle
  EXPECT_EQ(names_at_open_edges(mesh, 0.1), (PointNames{7, 1, 2, 3, 4, 5, 6, 7}));
}

TEST(Weld, ElementsAreRenamed) {
  Mesh mesh = torn_square(0);
  rename_points(mesh, names_of_equal_points(mesh));
  EXPECT_EQ(mesh.triangles, (std::vector<std::array<int, 3>>{{0, 1, 2}, {0, 2, 5}}));
  EXPECT_EQ(mesh.lines, (std::vector<std::array<int, 2>>{{0, 1}, {0, 2}}));
}

TEST(Weld, TornMeshesAreToldAndJoined) {
  Mesh mesh = torn_square(1e-7);
  mesh.named_points = {{3, {1, {"corner"}}}};
  const std::string torn = describe_unjoined(mesh);
  EXPECT_TRUE(torn.starts_with("2 points at open edges coincide with others within 1e-06")) << torn;
  EXPECT_TRUE(holds(torn, "the first at (0, 1e-07, 0)"));
  EXPECT_EQ(weld_open_edges(mesh, 1e-6),
            "welded 2 points at open edges to others (the first at (0, 1e-07, 0))");
  EXPECT_EQ(mesh.points.size(), 4u);
  EXPECT_EQ(mesh.triangles, (std::vector<std::array<int, 3>>{{0, 1, 2}, {0, 2, 3}}));
  EXPECT_EQ(mesh.lines.size(), 2u);
  EXPECT_EQ(mesh.named_points[0].point, 0);
  EXPECT_EQ(describe_unjoined(mesh), "");
  EXPECT_EQ(weld_open_edges(mesh, 1e-6), "");
}

}  // namespace
}  // namespace delquad
