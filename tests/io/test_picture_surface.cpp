// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/item_buffer.h"
#include "io/picture.h"
#include "io/svg.h"
#include "tests/support/files.h"
#include "tests/support/triangulated_shapes.h"

namespace delquad {
namespace {

using testing_support::box;

/// The box with quads.
Mesh quad_box(int n) {
  Mesh mesh = box(n);
  for (size_t t = 0; t < mesh.triangles.size(); t += 2) {
    const auto &a = mesh.triangles[t], &b = mesh.triangles[t + 1];
    mesh.quads.push_back({a[0], a[1], a[2], b[2]});
    mesh.quad_region.push_back(mesh.triangle_region[t]);
  }
  mesh.triangles.clear();
  mesh.triangle_region.clear();
  return mesh;
}

/// Closed shapes drawn.
size_t polygons(const std::string& svg) {
  size_t n = 0;
  for (size_t at = svg.find(" d=\"m"); at != std::string::npos; at = svg.find(" d=\"m", at + 1)) {
    const size_t end = svg.find('"', at + 4);
    n += static_cast<size_t>(
        std::count(svg.begin() + static_cast<long>(at), svg.begin() + static_cast<long>(end), 'z'));
  }
  return n;
}

std::string drawn(const Mesh& mesh) {
  const Folder folder;
  draw_mesh(folder / "a.svg", mesh, "<box>");
  return read_text(folder / "a.svg");
}

TEST(ItemBuffer, KeepsTheNearestAtEachSample) {
  ItemBuffer buffer(4, 4);
  buffer.add(0, {Vec3{0, 0, 1}, {3, 0, 1}, {0, 3, 1}});
  buffer.add(1, {Vec3{0, 0, 2}, {1, 0, 2}, {0, 1, 2}});
  buffer.add(2, {Vec3{0, 0, 0}, {3, 0, 0}, {3, 3, 0}});
  const std::vector<int> expected = {1, 1,  0,  0,  //
                                     1, 0,  0,  2,  //
                                     0, 0,  2,  2,  //
                                     0, -1, -1, 2};
  EXPECT_EQ(buffer.items(), expected);
  EXPECT_EQ(buffer.depth_around(3, 0), 0);
  EXPECT_EQ(buffer.depth_around(1, 3), ItemBuffer::kNothing);
}

TEST(DrawSurface, ShowsThreeSidesOfABox) {
  const std::string text = drawn(quad_box(6));
  EXPECT_GE(polygons(text), 3u * 6 * 6);
  EXPECT_LE(polygons(text), 3u * 6 * 6 + 6 * 6) << "some whose rim is seen";
  EXPECT_TRUE(holds(text, "&lt;box&gt;", ">eta<"));
}

TEST(DrawSurface, MarksOnlyTheIrregularVerticesThatAreSeen) {
  // Seven corners of valence 3 are seen, all but the one opposite to the viewer.
  const std::string text = drawn(quad_box(6));
  const std::string colour(svg::mark_colour(1));
  const size_t path = text.find("stroke=\"" + colour);
  ASSERT_NE(path, std::string::npos);
  const size_t data = text.find(" d=\"", path) + 4;
  const std::string dots = text.substr(data, text.find('"', data) - data);
  EXPECT_EQ(std::count(dots.begin(), dots.end(), 'm'), 7);
}

TEST(DrawSurface, LooksAtTheOpenSide) {
  // Only the lower sides of a box: from above their insides are seen, and all of them.
  Mesh mesh = box(4);
  std::vector<std::array<int, 3>> kept;
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (mesh.triangle_region[t] % 2 == 0) kept.push_back(mesh.triangles[t]);
  }
  mesh.triangles = kept;
  mesh.triangle_region.assign(kept.size(), 0);
  EXPECT_EQ(polygons(drawn(mesh)), kept.size());
}

TEST(DrawSurface, IsCompactAndDrawsNoEdgesOfManyElements) {
  const Mesh mesh = quad_box(80);
  const std::string text = drawn(mesh);
  EXPECT_LT(text.size(), 20 * mesh.quads.size());
  EXPECT_FALSE(holds(text, "#222"));
  EXPECT_EQ(text, drawn(mesh));
}

TEST(DrawSurface, SurvivesWhatHasNoExtent) {
  Mesh mesh = box(1);
  for (Vec3& p : mesh.points) p = {3, 3, 3};
  EXPECT_TRUE(holds(drawn(mesh), "</svg>"));
  for (Vec3& p : mesh.points) p = {0, 0, 1e-300 * p.x};
  EXPECT_TRUE(holds(drawn(mesh), "</svg>"));
}

/// Sides are divided into eight pieces, or lines would be the lines of the corners.
TEST(DrawSurface, DrawsCurvedSides) {
  const auto moves = [](const std::string& svg) {
    const size_t first = svg.find(" d=\"m"), last = svg.find('z', first);
    return std::count_if(svg.begin() + static_cast<long>(first), svg.begin() + static_cast<long>(last),
                         [](char c) { return c >= '0' && c <= '9' ? false : c == ' ' || c == '-'; });
  };
  const Mesh curved = curved_grid(1, 1, 2, true);
  Mesh straight = curved;
  straight.order = 1;
  straight.line_nodes = straight.quad_nodes = {};
  EXPECT_EQ(polygons(drawn(curved)), 1u);
  EXPECT_GT(moves(drawn(curved)), 60);
  EXPECT_LT(moves(drawn(straight)), 12);
}

}  // namespace
}  // namespace delquad
