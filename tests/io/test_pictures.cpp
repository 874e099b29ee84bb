// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/picture.h"
#include "io/svg.h"
#include "tests/support/files.h"

namespace delquad {
namespace {

size_t count(const std::string& text, const std::string& part) {
  size_t n = 0;
  for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

/// The drawing instructions of all paths.
std::string path_data(const std::string& text) {
  std::string data;
  for (size_t at = text.find(" d=\""); at != std::string::npos; at = text.find(" d=\"", at + 1)) {
    data += text.substr(at + 4, text.find('"', at + 4) - at - 4);
  }
  return data;
}

TEST(SvgPath, IsRelativeAndShort) {
  svg::Path path;
  path.polygon({{10, 20}, {15, 20}, {15, 10}, {5, 10}});
  path.segment({0, 0}, {-1, 1});
  EXPECT_EQ(path.data(), "m10 20 5 0 0-10-10 0zm-10-20-1 1");
}

TEST(SvgColour, EndsAndMiddleOfTheMap) {
  EXPECT_EQ(svg::colour(0), "#440154");
  EXPECT_EQ(svg::colour(0.5), "#21918c");
  EXPECT_EQ(svg::colour(1), "#fde725");
  EXPECT_EQ(svg::colour(-3), svg::colour(0));
  EXPECT_EQ(svg::colour(3), svg::colour(1));
}

TEST(SvgPicture, PutsYUpAndKeepsTheShape) {
  const svg::Picture picture({{-1, 2, 0}, {3, 4, 0}}, "");
  EXPECT_EQ(picture.spot(-1, 4).x, 0);
  EXPECT_EQ(picture.spot(-1, 4).y, 0);
  EXPECT_EQ(picture.spot(3, 2).x, 2 * picture.spot(3, 2).y) << "4 by 2 units";
}

TEST(SvgPicture, SurvivesBoxesWithoutWidthHeightOrBoth) {
  for (const std::vector<Vec3>& points : {std::vector<Vec3>{},
                                          {{1, 1, 0}},
                                          {{1, 1, 0}, {1, 5, 0}},
                                          {{0, 0, 0}, {1e-300, 0, 0}},
                                          {{-1e308, 0, 0}, {1e308, 1, 0}}}) {
    const svg::Picture picture(points, "");
    EXPECT_GT(picture.scale(), 0);
    EXPECT_TRUE(std::isfinite(picture.scale()));
    for (const Vec3& p : points) picture.spot(p);
  }
}

TEST(DrawMesh, HasOnePolygonAnElementAndEscapesItsTitle) {
  const Folder folder;
  draw_mesh(folder / "a.svg", quad_grid(7, 5), "<D> & B");
  const std::string text = read_text(folder / "a.svg");
  EXPECT_EQ(count(path_data(text), "z"), 7u * 5);
  EXPECT_TRUE(holds(text, "&lt;D&gt; &amp; B"));
  EXPECT_EQ(count(text, "valence"), 0u) << "all vertices are regular";
  EXPECT_TRUE(holds(text, ">eta<"));
}

TEST(DrawMesh, MarksIrregularVerticesByValence) {
  const Folder folder;
  Mesh mesh = quad_grid(2, 2);
  mesh.quads.erase(mesh.quads.begin());
  mesh.quad_region.pop_back();
  mesh.triangles = {{0, 1, 4}, {0, 4, 3}};
  mesh.triangle_region = {0, 0};
  draw_mesh(folder / "a.svg", mesh, "");
  const std::string text = read_text(folder / "a.svg");
  // The dot of valence 5 in the middle, and once in the legend.
  EXPECT_EQ(count(text, std::string(svg::mark_colour(-1))), 2u);
  EXPECT_EQ(count(text, std::string(svg::mark_colour(1))), 1u);
}

TEST(DrawMesh, JoinsPairsOfIrregularVertices) {
  const Folder folder;
  Mesh mesh = quad_grid(6, 5);
  // The edge in the middle is turned: two pairs.
  mesh.quads[14] = {16, 17, 18, 23};
  mesh.quads[15] = {18, 25, 24, 23};
  draw_mesh(folder / "a.svg", mesh, "");
  const std::string text = read_text(folder / "a.svg");
  EXPECT_EQ(count(text, svg::kPairColour), 2u) << "the lines, and once in the legend";
  EXPECT_EQ(count(text, ">pair<"), 1u);
}

TEST(DrawMesh, OfTrianglesHasNoColourBar) {
  const Folder folder;
  draw_mesh(folder / "a.svg", triangle_grid(4, 4), "");
  EXPECT_FALSE(holds(read_text(folder / "a.svg"), ">eta<"));
}

TEST(DrawMesh, StaysSmallForManyElements) {
  const Folder folder;
  constexpr int n = 250;
  draw_mesh(folder / "a.svg", quad_grid(n, n), "");
  EXPECT_LT(fs::file_size(folder / "a.svg"), 30.0 * n * n);
  EXPECT_FALSE(holds(read_text(folder / "a.svg"), "#222")) << "edges are not drawn";
}

TEST(Pictures, AreTheSameBytesTwice) {
  const Folder folder;
  for (const char* name : {"a.svg", "b.svg"}) draw_mesh(folder / name, quad_grid(9, 9, 1, 3), "title");
  EXPECT_EQ(read_text(folder / "a.svg"), read_text(folder / "b.svg"));
}

}  // namespace
}  // namespace delquad
