#include <gtest/gtest.h>

#include "features/curves/surface_input.h"
#include "io/cases/case_file.h"
#include "tests/support/expect_input_error.h"
#include "tests/support/temporary_folder.h"

namespace delquad {
namespace {

using testing_support::TemporaryFolder;
using testing_support::write_text;

SurfaceSpec read(const std::string& keys) {
  const TemporaryFolder folder;
  const auto file = write_text(folder / "m.toml", "model = \"part.step\"\n[surface]\n" + keys);
  return read_model_case(file).surface;
}

TEST(SurfaceSpecs, AreReadWhole) {
  const SurfaceSpec spec = read(
      "compound = [[1, 2, 5], [7, 8]]\nmerge_curves = 2.5\nignore_below = 0.5\nfeature_angle = "
      "30\nweld_tolerance = 1e-5\n"
      "glue = true\n"
      "mirror = { point = [1, 2, 3], normal = [0, 0, 2], tolerance = 1e-4, join = false }\n");
  EXPECT_EQ(spec.compounds, Compounds::kGroups);
  EXPECT_EQ(spec.groups, (std::vector<std::vector<int>>{{1, 2, 5}, {7, 8}}));
  EXPECT_EQ(spec.merge_curves, 2.5);
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
  const TemporaryFolder folder;
  const auto with = [&](const std::string& keys) {
    return read_model_case(write_text(folder / "m.toml", "model = \"part.step\"\n" + keys));
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
  expect_input_error([&] { with("washers = [{ diameter = [5, 12], rows = -1 }]\n"); },
                     {"m.toml:2", "'rows' is -1", "1 to 1000"});
  expect_input_error([&] { with("washers = [{ diameter = 5 }]\n"); }, {"m.toml:2", "'washers.diameter'"});
  expect_input_error([&] { with("washers = [{ diameter = [5, 6], edge = 8 }]\n"); }, {"m.toml:2", "'edges'"});
}

TEST(SurfaceSpecs, TheMirrorWeldsAsTheModelDoes) {
  EXPECT_EQ(
      read("weld_tolerance = 1e-5\nmirror = { point = [0, 0, 0], normal = [0, 0, 1] }\n").mirror->tolerance,
      1e-5);
}

TEST(SurfaceSpecs, NonsenseIsRefusedWithItsLine) {
  const auto refused = [](const std::string& keys, std::initializer_list<const char*> parts) {
    expect_input_error([&] { read(keys); }, parts);
  };
  refused("compound = \"most\"\n", {"m.toml:3", "'most'", "all or tangent"});
  refused("glue = 1\n", {"m.toml:3", "glue"});
  refused("compound = 3\n", {"m.toml:3", "list of lists"});
  refused("compound = [1, 2]\n", {"m.toml:3", "list of lists"});
  refused("compound = [[1, 2.5]]\n", {"m.toml:3", "list of lists"});
  refused("compound = [[1, 3000000000]]\n", {"m.toml:3", "list of lists"});
  refused("compound = [[1, 2], []]\n", {"m.toml:3", "two faces"});
  refused("merge_curves = 0\n", {"m.toml:3", "merge_curves"});
  refused("ignore_below = -1\n", {"m.toml:3", "ignore_below"});
  refused("feature_angle = 200\n", {"m.toml:3", "200"});
  refused("weld_tolerance = 1\n", {"m.toml:3", "0.1"});
  refused("weld = 1e-5\n", {"m.toml:3", "weld"});
  refused("\nmirror = { point = [0, 0], normal = [0, 0, 1] }\n", {"m.toml:4", "point", "three numbers"});
  refused("mirror = { point = [0, 0, 0], normal = [0, 0, 0] }\n", {"m.toml:3", "no length"});
  refused("mirror = { point = [0, 0, 0], normal = [0, 0, 1], tolerance = -1 }\n", {"m.toml:3", "tolerance"});
  refused("mirror = { point = [0, 0, 0], normal = [0, 0, 1], plane = 1 }\n", {"m.toml:3", "plane"});
}

TEST(SurfaceSpecs, WhatDoesNothingForCadIsRefused) {
  const auto made = [](const char* spec) {
    MeshProblem problem;
    problem.model = ExampleModel{"bracket"};
    problem.surface = read(spec);
    return make_surface(problem);
  };
  expect_input_error([&] { made("mirror = { point = [0, 0, 0], normal = [0, 0, 1] }\n"); },
                     {"m.toml:2", "CAD"});
  expect_input_error([&] { made("feature_angle = 20\n"); }, {"m.toml:2", "CAD"});
}

}  // namespace
}  // namespace delquad
