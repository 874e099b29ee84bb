#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <set>

#include "io/mesh_io.h"
#include "tests/program/program.h"
#include "tests/support/temporary_folder.h"

namespace delquad::testing_support {
namespace {

struct Example {
  const char *name, *size;
  int euler;
};

void PrintTo(const Example& example, std::ostream* out) { *out << example.name; }

TEST(ExampleCommand, WhatIsLeftOutIsToldByInfoToo) {
  const TemporaryFolder folder;
  const auto file = folder / "box.step";
  ASSERT_EQ(delquad({"example", "thin_box", "-o", file}).exit_code, 0);
  std::ifstream in(file);
  std::string text{std::istreambuf_iterator<char>(in), {}};
  const std::size_t at = text.find(" = ADVANCED_FACE("), begin = text.rfind('#', at);
  ASSERT_NE(at, std::string::npos);
  text.erase(begin, text.find(';', at) + 1 - begin);
  std::ofstream(file) << text;
  const auto refused = delquad({"info", file});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_TRUE(contains(refused.err, "cannot be read: #16 (ClosedShell)")) << refused.err;
  const auto rest = delquad({"info", file, "--keep-going", "--glue"});
  EXPECT_EQ(rest.exit_code, 4);
  EXPECT_TRUE(contains(rest.err, "error: left out: 1 part of the STEP file")) << rest.err;
  EXPECT_TRUE(contains(rest.out, "glue")) << rest.out;
  // A mesh that fails for another reason: too narrow corners.
  const auto failed =
      delquad({"mesh", file, "--keep-going", "--size", "5", "--min-angle", "89.9", "-o", folder / "box.msh"});
  EXPECT_EQ(failed.exit_code, 5);
  EXPECT_TRUE(contains(failed.err, "error: left out: 1 part of the STEP file")) << failed.err;
}

class Examples : public ::testing::TestWithParam<Example> {};

TEST_P(Examples, AreWrittenAndMeshedWithQuadsOnly) {
  const Example& example = GetParam();
  const TemporaryFolder folder;
  for (const char* extension : {".step", ".brep"}) {
    const auto file = folder / (std::string(example.name) + extension);
    const auto written = delquad({"example", example.name, "-o", file});
    ASSERT_EQ(written.exit_code, 0) << written.err;
    EXPECT_EQ(written.out, file.string() + "\n");
    const auto meshed = delquad({"mesh", file, "-o", folder / "out.msh", "--size", example.size});
    ASSERT_EQ(meshed.exit_code, 0) << meshed.err;
    const Mesh mesh = read_mesh(folder / "out.msh");
    EXPECT_EQ(check_invariants(mesh), std::vector<std::string>{});
    EXPECT_TRUE(mesh.triangles.empty());
    std::set<std::pair<int, int>> edges;
    for (const auto& quad : mesh.quads)
      for (std::size_t k = 0; k < 4; ++k) edges.insert(std::minmax(quad[k], quad[(k + 1) % 4]));
    EXPECT_EQ(static_cast<int>(mesh.points.size() + mesh.quads.size()) - static_cast<int>(edges.size()),
              example.euler);
  }
}

const auto name_of_example = [](const auto& param) { return param.param.name; };
INSTANTIATE_TEST_SUITE_P(Shapes, Examples,
                         ::testing::Values(Example{"bracket", "3", -8}, Example{"hood", "60", 1},
                                           Example{"sphere", "2", 2}, Example{"torus", "3", 0},
                                           Example{"sheet", "4", -5}),
                         name_of_example);
INSTANTIATE_TEST_SUITE_P(OthersLong, Examples,
                         ::testing::Values(Example{"pipe_tee", "5", -1}, Example{"wing_body", "3", 2},
                                           Example{"blended_tee", "5", -2}, Example{"cone_tip", "4", 0},
                                           Example{"cross_drilled", "4", -6}, Example{"elbow", "4", 0},
                                           Example{"fins", "4", 0}, Example{"free_form", "4", -2},
                                           Example{"loft", "4", 2}, Example{"thin_box", "4", -10},
                                           Example{"variable_fillet", "4", 0}),
                         name_of_example);

TEST(ExampleCommand, KeepsTheNamesOfFacesInStep) {
  const TemporaryFolder folder;
  ASSERT_EQ(delquad({"example", "bracket", "-o", folder / "b.step"}).exit_code, 0);
  ASSERT_EQ(delquad({"mesh", folder / "b.step", "-o", folder / "b.msh", "--size", "4"}).exit_code, 0);
  std::set<std::string> names;
  for (const Entity& region : read_mesh(folder / "b.msh").regions)
    names.insert(region.names.begin(), region.names.end());
  EXPECT_EQ(names, (std::set<std::string>{"base", "body", "bore", "bracket", "holes"}));
}

TEST(ExampleCommand, TakesBothNamesOfStep) {
  const TemporaryFolder folder;
  for (const char* name : {"a.step", "a.stp"})
    ASSERT_EQ(delquad({"example", "torus", "-o", folder / name}).exit_code, 0);
  EXPECT_EQ(read_text(folder / "a.step"), read_text(folder / "a.stp"));
}

TEST(ExampleCommand, ListsAll) {
  const auto list = delquad({"example", "--list"});
  EXPECT_EQ(list.exit_code, 0);
  for (const char* name : {"bracket", "hood", "pipe_tee", "sphere", "torus", "wing_body"})
    EXPECT_TRUE(contains("\n" + list.out, std::string("\n") + name + " ")) << name;
}

TEST(ExampleCommand, RefusesMistakes) {
  const TemporaryFolder folder;
  const auto refused = [&](std::vector<std::string> arguments, const std::string& part) {
    arguments.insert(arguments.begin(), "example");
    const auto result = delquad(arguments);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_TRUE(contains(result.err, part)) << result.err;
    EXPECT_TRUE(folder.names().empty());
  };
  refused({"brackett", "-o", folder / "a.step"}, "known: bracket, hood, pipe_tee");
  refused({"bracket", "-o", folder / "a.igs"}, "known: .step, .stp, .brep");
  refused({"bracket", "-o", folder / "none/a.step"}, "there is no folder");
  refused({"bracket"}, "expected -o");
  refused({}, "--list");
  refused({"bracket", "--list"}, "--list");
}

TEST(ExampleCommand, FewEdgesToATurnAreToldWithWhatHelps) {
  const TemporaryFolder folder;
  ASSERT_EQ(delquad({"example", "torus", "-o", folder / "torus.brep"}).exit_code, 0);
  std::vector<std::string> words = {"mesh", folder / "torus.brep", "-o", folder / "m.msh", "--size", "8"};
  EXPECT_TRUE(contains(delquad(words).err, "1 face gets fewer than 12 edges to a full turn, the fewest "))
      << delquad(words).err;
  EXPECT_TRUE(contains(delquad(words).err, "(face 1): --curvature 12 would help\n")) << delquad(words).err;
  words.insert(words.end(), {"--curvature", "12"});
  EXPECT_FALSE(contains(delquad(words).err, "full turn")) << delquad(words).err;
}

/// The kernel works in a child process, and is seen there.
TEST(ExampleCommand, TimeLimitEndsTheKernelToo) {
  const TemporaryFolder folder;
  ASSERT_EQ(delquad({"example", "wing_body", "-o", folder / "w.brep"}).exit_code, 0);
  const auto run = delquad({"info", folder / "w.brep", "--time-limit", "0.02"});
  EXPECT_EQ(run.exit_code, 1) << run.err;
  EXPECT_TRUE(contains(run.err, "(--time-limit): ")) << run.err;
  EXPECT_FALSE(contains(run.err, "starting")) << run.err;
}

TEST(ExampleCommand, ExperimentsTakeExamples) {
  const TemporaryFolder folder;
  std::ofstream(folder / "e.toml")
      << "pipelines = [\"DB\"]\n[[case]]\nname = \"ball\"\nexample = \"sphere\"\n"
         "size = 3\n";
  const auto run = delquad({"run", folder / "e.toml", "-o", folder / "out"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Mesh mesh = read_mesh(folder / "out/ball/DB/mesh.msh");
  EXPECT_EQ(mesh.points.size(), mesh.quads.size() + 2);
  EXPECT_TRUE(contains(read_text(folder / "out/ball/DB/record.json"), "\"model\": \"example sphere\""));

  std::ofstream(folder / "m.toml") << "example = \"torus\"\nsize = 4\n";
  EXPECT_EQ(delquad({"mesh", folder / "m.toml", "-o", folder / "m.msh"}).exit_code, 0);
  EXPECT_EQ(delquad({"info", folder / "m.toml"}).exit_code, 0);

  std::ofstream(folder / "bad.toml") << "[[case]]\nname = \"a\"\nexample = \"ball\"\nsize = 3\n";
  const auto bad = delquad({"run", folder / "bad.toml", "-o", folder / "bad"});
  EXPECT_EQ(bad.exit_code, 2);
  EXPECT_TRUE(contains(bad.err, "bad.toml:3: unknown example 'ball'; known: bracket")) << bad.err;
  std::ofstream(folder / "two.toml") << "example = \"torus\"\nsize = 3\n" + kSquare;
  const auto two = delquad({"mesh", folder / "two.toml", "-o", folder / "two.msh"});
  EXPECT_EQ(two.exit_code, 2);
  EXPECT_TRUE(contains(two.err, "'example' and another model exclude each other")) << two.err;
}

}  // namespace
}  // namespace delquad::testing_support
