// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/cases/case_file.h"
#include "io/cases/case_keys.h"
#include "io/cases/model_file.h"
#include "tests/support/files.h"

namespace delquad {
namespace {

class ModelFiles : public testing::Test {
 protected:
  PlanarModel read(const std::string& text) {
    const TomlTable table = TomlTable::read(write_text(folder_ / "m.toml", text));
    table.require_known(case_keys());
    return read_planar_model(table);
  }
  Folder folder_;
};

TEST_F(ModelFiles, RectangleRunsRoundFromItsLowerLeftCorner) {
  const PlanarModel model = read("loop = { rectangle = [[2, 3], [0, 1]], boundary = ['b', 'r', 't', 'l'] }");
  ASSERT_EQ(model.curves.size(), 4u);
  const Vec2 corners[] = {{0, 1}, {2, 1}, {2, 3}, {0, 3}};
  const char* names[] = {"b", "r", "t", "l"};
  for (int k = 0; k < 4; ++k) {
    EXPECT_EQ(model.curves[k].shape->point(0), corners[k]);
    EXPECT_EQ(model.curves[k].shape->point(1), corners[(k + 1) % 4]);
    EXPECT_EQ(model.curves[k].name, names[k]);
  }
  EXPECT_EQ(model.loops.size(), 1u);
}

TEST_F(ModelFiles, CurvesOfEveryKind) {
  const PlanarModel model = read(
      "[[curve]]\nname = 's'\nsegment = [[0, 0], [1, 0]]\n"
      "[[curve]]\nname = 'a'\nboundary = 'round'\narc = { centre = [1, 1], radius = 1, from = -90, to = 90 "
      "}\n"
      "[[curve]]\nname = 'p'\npolyline = [[1, 2], [0.5, 2.5], [0, 2]]\n"
      "[[curve]]\nname = 'e'\nexpression = { x = 0, y = '2*(1 - t)', from = 0, to = 1 }\n"
      "[[loop]]\ncurves = ['s', 'a', 'p', 'e']\nregion = 'inside'\n");
  ASSERT_EQ(model.curves.size(), 4u);
  EXPECT_EQ(model.curves[1].name, "round");
  const Vec2 east = model.curves[1].shape->point(0.5);
  EXPECT_NEAR(east.x, 2, 1e-15);
  EXPECT_NEAR(east.y, 1, 1e-15);
  EXPECT_EQ(model.curves[2].shape->fixed_parameters().size(), 1u);
  EXPECT_EQ(model.curves[3].shape->point(1), (Vec2{0, 0}));
  EXPECT_EQ(model.loops[0].curves, (std::vector<int>{0, 1, 2, 3}));
  EXPECT_EQ(model.loops[0].region, "inside");
}

TEST_F(ModelFiles, PatternRepeatsItsShape) {
  const PlanarModel model = read(
      "loop = { rectangle = [[0, 0], [3, 2]] }\n"
      "pattern = { circle = { centre = [0.5, 0.5], radius = 0.25 }, count = [3, 2], step = [1, 1], hole = "
      "true }\n");
  ASSERT_EQ(model.loops.size(), 7u);
  EXPECT_EQ(model.curves.back().shape->point(0), (Vec2{2.75, 1.5}));
  EXPECT_FALSE(model.loops[0].is_hole);
  for (int k = 1; k < 7; ++k) EXPECT_TRUE(model.loops[k].is_hole) << k;
  EXPECT_EQ(model.curves[model.loops[2].curves[0]].shape->point(0), (Vec2{1.75, 0.5}));
}

TEST_F(ModelFiles, LinesEmbeddedInSurfaces) {
  const auto read_surface = [&](const std::string& text) {
    write_text(folder_ / "s.toml", text);
    return read_model_case(folder_ / "s.toml");
  };
  const std::string sphere = "example = 'sphere'\n";
  const Case c = read_surface(sphere +
                              "embed = [{ polyline = [[10, 0, 0], [0, 10, 0]], name = 'way' },\n"
                              "         { point = [0, 0, 10] }]\n[surface]\ncompound = 'all'\n");
  ASSERT_EQ(c.surface.embed.size(), 2u);
  EXPECT_EQ(c.surface.embed[0].points, (std::vector<Vec3>{{10, 0, 0}, {0, 10, 0}}));
  EXPECT_EQ(c.surface.embed[0].name, "way");
  EXPECT_EQ(c.surface.embed[1].points, (std::vector<Vec3>{{0, 0, 10}}));
  EXPECT_EQ(c.surface.compounds, Compounds::kAll);
}

TEST_F(ModelFiles, EmbeddedCurvesAndPoints) {
  const PlanarModel model = read(
      "loop = { rectangle = [[0, 0], [2, 2]] }\n"
      "embed = [{ segment = [[0, 1], [1, 1]], name = 'fault' }, { point = [1.5, 0.5], name = 'sensor' },\n"
      "         { arc = { centre = [1, 1], radius = 0.5, from = 0, to = 90 }, crack = true }]\n");
  ASSERT_EQ(model.curves.size(), 6u);
  EXPECT_EQ(model.curves[4].name, "fault");
  EXPECT_FALSE(model.curves[4].is_crack);
  EXPECT_TRUE(model.curves[5].is_crack);
  ASSERT_EQ(model.points.size(), 1u);
  EXPECT_EQ(model.points[0].at, (Vec2{1.5, 0.5}));
  EXPECT_EQ(model.points[0].name, "sensor");
  write_text(folder_ / "way.txt", "0.5 0.5\n1 1\n");
  const PlanarModel way = read("loop = { rectangle = [[0, 0], [2, 2]] }\nembed = { polyline = \"way.txt\" }");
  EXPECT_EQ(way.curves.back().shape->point(1), (Vec2{1, 1}));
}

}  // namespace
}  // namespace delquad
