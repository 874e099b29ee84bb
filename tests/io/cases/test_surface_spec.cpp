// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/cases/case_file.h"
#include "tests/support/files.h"

namespace delquad {
namespace {

SurfaceSpec read(const std::string& keys) {
  const Folder folder;
  const auto file = write_text(folder / "m.toml", "model = 'part.step'\n[surface]\n" + keys);
  return read_model_case(file).surface;
}

TEST(SurfaceSpecs, AreReadWhole) {
  const SurfaceSpec spec = read(
      "compound = [[1, 2, 5], [7, 8]]\nignore_below = 0.5\nfeature_angle = "
      "30\nweld_tolerance = 1e-5\n"
      "glue = true\n"
      "mirror = { point = [1, 2, 3], normal = [0, 0, 2], tolerance = 1e-4, join = false }\n");
  EXPECT_EQ(spec.compounds, Compounds::kGroups);
  EXPECT_EQ(spec.groups, (std::vector<std::vector<int>>{{1, 2, 5}, {7, 8}}));
  EXPECT_EQ(spec.ignore_below, 0.5);
  EXPECT_EQ(spec.feature_angle, 30);
  EXPECT_EQ(spec.weld_tolerance, 1e-5);
  EXPECT_TRUE(spec.glue);
  EXPECT_FALSE(read("feature_angle = 30\n").glue);
  ASSERT_TRUE(spec.mirror);
  EXPECT_EQ(spec.mirror->point, (Vec3{1, 2, 3}));
  EXPECT_EQ(spec.mirror->tolerance, 1e-4);
  EXPECT_FALSE(spec.mirror->join);
  EXPECT_EQ(read("compound = \"tangent\"\n").compounds, Compounds::kTangent);
  EXPECT_TRUE(read_model_case("part.step").surface.where.empty());
}

TEST(SurfaceSpecs, HolesAndFilletsHaveRanges) {
  const Folder folder;
  const auto with = [&](const std::string& keys) {
    return read_model_case(write_text(folder / "m.toml", "model = 'part.step'\n" + keys));
  };
  const Case c = with(
      "washers = [{ diameter = [5, 12], rows = 2, edges = 16, width = 4 }, { diameter = [12, 20] }]\n"
      "fillet_rows = { radius = [1, 2.5], rows = 3 }\nsurface.fill_holes = 2\n");
  ASSERT_EQ(c.washers.size(), 2u);
  EXPECT_EQ(c.washers[0].most, 12);
  EXPECT_EQ(c.washers[0].rows, 2);
  EXPECT_EQ(c.washers[0].edges, 16);
  EXPECT_EQ(c.washers[0].width, 4);
  EXPECT_EQ(c.washers[1].rows, 1);
  EXPECT_EQ(c.washers[1].edges, 0);
  ASSERT_EQ(c.fillet_rows.size(), 1u);
  EXPECT_EQ(c.fillet_rows[0].rows, 3);
  EXPECT_EQ(c.surface.fill_holes, 2);
}

TEST(SurfaceSpecs, TheMirrorWeldsAsTheModelDoes) {
  EXPECT_EQ(
      read("weld_tolerance = 1e-5\nmirror = { point = [0, 0, 0], normal = [0, 0, 1] }\n").mirror->tolerance,
      1e-5);
}

}  // namespace
}  // namespace delquad
