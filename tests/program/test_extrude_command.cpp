#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "io/mesh_io.h"
#include "tests/program/program.h"
#include "tests/support/grid_mesh.h"

namespace delquad::testing_support {
namespace {

TEST(ExtrudeCommand, SweepsWhatMeshWrites) {
  const TemporaryFolder folder;
  const auto model = write_text(folder / "m.toml", kSquare + "size = 0.25\n");
  ASSERT_EQ(delquad({"mesh", model, "-o", folder / "q.msh"}).exit_code, 0);
  for (const char* name : {"a.msh", "a.vtu", "a.inp"}) {
    const ProgramResult result =
        delquad({"extrude", folder / "q.msh", "--along", "0,0,3", "--layers", "5", "--growth", "1.3", "-o",
                 folder / name, "--json", folder / "r.json"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.err, "");
    EXPECT_TRUE(contains(result.out, "hexahedra            80")) << result.out;
    const auto record = nlohmann::json::parse(read_text(folder / "r.json"));
    EXPECT_EQ(record["hexahedra"], 80);
    EXPECT_EQ(record["points"], 150);
    EXPECT_NEAR(record["volume"], 3, 1e-12);
    EXPECT_NEAR(record["least_scaled_jacobian"], 1, 1e-12);
    EXPECT_EQ(record["volumes"][0]["names"][0], "square");
    EXPECT_EQ(record["faces"].size(), 6u);
    EXPECT_EQ(record["faces"][0], (nlohmann::json{{"number", 1}, {"names", {"bottom"}}, {"quads", 20}}));
  }
  EXPECT_TRUE(contains(read_text(folder / "a.msh"), "3 7 \"square\""))
      << read_text(folder / "a.msh").substr(0, 300);
  EXPECT_TRUE(contains(read_text(folder / "a.inp"), "*SURFACE, NAME=square_start, TYPE=ELEMENT"));
}

TEST(ExtrudeCommand, AllWays) {
  const TemporaryFolder folder;
  write_mesh(folder / "q.vtu", quad_grid(4, 4));
  const auto volume = [&](std::vector<std::string> options) {
    std::vector<std::string> words = {"extrude",        folder / "q.vtu", "-o",
                                      folder / "a.vtu", "--json",         folder / "r.json"};
    words.insert(words.end(), options.begin(), options.end());
    const ProgramResult result = delquad(words);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return nlohmann::json::parse(read_text(folder / "r.json"))["volume"].get<double>();
  };
  const double pi = std::acos(-1);
  EXPECT_NEAR(volume({"--along", "0,3,4", "--thickness", "2.5", "--layers", "2"}), 2, 1e-12);
  EXPECT_NEAR(volume({"--around", "-1,0,0,0,1,0", "--layers", "100"}), 2 * pi * 1.5, 0.01);
  EXPECT_NEAR(volume({"--around", "-1,0,0,0,1,0", "--angle", "-60", "--layers", "20"}), pi / 3 * 1.5, 0.01);
  EXPECT_NEAR(volume({"--normals", "--thickness", "-0.5", "--layers", "2"}), 0.5, 1e-12);
  EXPECT_NEAR(volume({"--normals", "--thickness", "0.5", "--both-sides", "--layers", "2"}), 0.5, 1e-12);
  const auto points = write_text(folder / "p.txt", "# from here\n0 0 0\n 0 0 1 # a corner\n\n0 0 4\n");
  EXPECT_NEAR(volume({"--curve", points}), 4, 1e-12);
  EXPECT_NEAR(volume({"--curve", points, "--layers", "7", "--growth", "0.8"}), 4, 1e-12);
  // A chain of a mesh, given backwards: it begins at the end that is nearer to the section.
  Mesh rail;
  rail.points = {{0, 0, 9}, {0, 0, 6}, {0, 0, 1}, {0, 5, 1}};
  rail.lines = {{0, 1}, {1, 2}, {2, 3}};
  rail.line_curve = {0, 0, 1};
  rail.curves = {{1, {"rail"}}, {2, {"other"}}};
  write_mesh(folder / "rail.msh", rail);
  EXPECT_NEAR(volume({"--curve", (folder / "rail.msh").string() + ":rail"}), 8, 1e-12);
  EXPECT_EQ(nlohmann::json::parse(read_text(folder / "r.json"))["hexahedra"], 32);
}

TEST(ExtrudeCommand, WrongUseIsRefusedAndNothingIsWritten) {
  const TemporaryFolder folder;
  write_mesh(folder / "q.msh", quad_grid(4, 4));
  write_mesh(folder / "t.msh", triangle_grid(4, 4));
  const auto bad = write_text(folder / "bad.txt", "0 0 0\n0 0 1 7\n");
  const auto fork = [&] {
    Mesh mesh;
    mesh.points = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}};
    mesh.lines = {{0, 1}, {0, 2}, {0, 3}};
    mesh.line_curve = {0, 0, 0};
    mesh.curves = {{1, {}}};
    write_mesh(folder / "fork.msh", mesh);
    return (folder / "fork.msh").string();
  }();
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
      {{"--layers", "2"}, "expected one of --along, --around, --curve and --normals"},
      {{"--along", "0,0,1", "--normals", "--layers", "2"}, "expected one of"},
      {{"--along", "0,0,1"}, "--layers is missing"},
      {{"--along", "0,0", "--layers", "2"}, "--along '0,0': expected 3 finite numbers"},
      {{"--along", "0,0,x", "--layers", "2"}, "expected 3 finite numbers"},
      {{"--along", "0,0,0", "--layers", "2"}, "not all 0"},
      {{"--along", "1,0,0", "--layers", "2"}, "32 of 32 hexahedra are inverted or flat"},
      {{"--along", "0,0,1", "--layers", "0"}, "--layers"},
      {{"--along", "0,0,1", "--layers", "2", "--angle", "3"}, "--angle goes with --around only"},
      {{"--along", "0,0,1", "--layers", "2", "--both-sides"}, "--both-sides goes with --normals only"},
      {{"--around", "5,0,0,0,1,0", "--layers", "9", "--thickness", "3"}, "--thickness goes with"},
      {{"--around", "0.3,0,0,0,1,0", "--layers", "9"}, "crosses its axis"},
      {{"--normals", "--layers", "2"}, "--normals needs --thickness"},
      {{"--along", "0,0,1", "--layers", "1e6"}, "--layers"},
      {{"--along", "0,0,1", "--layers", "1000", "--max-elements", "1e4"}, "more than 10000 hexahedra"},
      {{"--curve", bad}, "bad.txt:2: more than three coordinates"},
      {{"--curve", folder / "none.txt"}, "none.txt"},
      {{"--curve", fork}, "3 lines meet at (0, 0, 0)"},
      {{"--curve", fork + ":x"}, "no curve has the name 'x'"},
      {{"--curve", (folder / "q.msh").string() + ":west", "--layers", "3"}, "inverted or flat"},
      {{"--curve", folder / "q.msh"}, "have 0 ends"},
      {{"--curve", "what"}, "expected a file of points (.txt)"},
  };
  for (const auto& [options, message] : cases) {
    std::vector<std::string> words = {"extrude", folder / "q.msh", "-o", folder / "a.vtu"};
    words.insert(words.end(), options.begin(), options.end());
    const ProgramResult result = delquad(words);
    EXPECT_EQ(result.exit_code, 2) << message;
    EXPECT_TRUE(contains(result.err, message)) << message << " is not in: " << result.err;
    EXPECT_EQ(std::ranges::count(result.err, '\n'), 1) << result.err;
  }
  const ProgramResult triangles =
      delquad({"extrude", folder / "t.msh", "-o", folder / "a.vtu", "--along", "0,0,1", "--layers", "1"});
  EXPECT_EQ(triangles.exit_code, 2);
  EXPECT_TRUE(contains(triangles.err, "t.msh: the mesh has 32 triangles beside 0 quads")) << triangles.err;
  const ProgramResult format =
      delquad({"extrude", folder / "q.msh", "-o", folder / "a.k", "--along", "0,0,1", "--layers", "1"});
  EXPECT_EQ(format.exit_code, 2);
  EXPECT_TRUE(contains(format.err, "expected .msh, .vtu, .inp, ")) << format.err;
  EXPECT_EQ(folder.names(), (std::vector<std::string>{"bad.txt", "fork.msh", "q.msh", "t.msh"}));
}

}  // namespace
}  // namespace delquad::testing_support
