#include <gtest/gtest.h>

#include <cmath>

#include "geometry/mesh/half_edges.h"
#include "io/mesh_io.h"
#include "tests/program/program.h"
#include "tests/support/grid_mesh.h"

namespace delquad::testing_support {
namespace {

/// A grid with a third of its inner points moved.
Mesh bad_grid() {
  Mesh mesh = quad_grid(8, 8);
  for (int v = 0; v < 81; v += 3)
    if (v % 9 != 0 && v % 9 != 8 && v > 8 && v < 72) mesh.points[v] = mesh.points[v] + Vec3{0.07, 0.05, 0};
  return mesh;
}

TEST(ImproveCommand, PrintsBeforeAndAfterAndKeepsNames) {
  for (const char* name : {"a.msh", "a.vtu", "a.inp", "a.mesh", "a.obj"}) {
    const TemporaryFolder folder;
    write_mesh(folder / name, bad_grid());
    const ProgramResult result =
        delquad({"improve", folder / name, "-o", folder / "out.msh", "--json", folder / "record.json"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.err, "");
    const std::size_t before = result.out.find("eta mean"), after = result.out.rfind("eta mean");
    ASSERT_NE(before, after);
    EXPECT_LT(std::stod(result.out.substr(before + 9)), 0.9) << name;
    EXPECT_GT(std::stod(result.out.substr(after + 9)), 0.99) << name;
    EXPECT_TRUE(contains(read_text(folder / "record.json"), "\"given\": true"));
    const Mesh given = read_mesh(folder / name), better = read_mesh(folder / "out.msh");
    EXPECT_EQ(better.lines.size(), given.lines.size()) << name;
    ASSERT_EQ(better.curves.size(), given.curves.size()) << name;
    for (std::size_t i = 0; i < given.curves.size(); ++i)
      EXPECT_EQ(better.curves[i].names, given.curves[i].names) << name;
  }
}

TEST(ImproveCommand, TrianglesAreMergedUnlessTheWordIsForQuads) {
  const TemporaryFolder folder;
  write_mesh(folder / "t.msh", triangle_grid(6, 6));
  ASSERT_EQ(delquad({"improve", folder / "t.msh", "-o", folder / "out.msh"}).exit_code, 0);
  EXPECT_EQ(read_mesh(folder / "out.msh").quads.size(), 36u);
  const ProgramResult refused =
      delquad({"improve", folder / "t.msh", "--pipeline", "CO", "-o", folder / "none.msh"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_TRUE(contains(refused.err, "72 triangles and no quads")) << refused.err;
  EXPECT_FALSE(std::filesystem::exists(folder / "none.msh"));
}

TEST(ImproveCommand, ModelsAndExperimentsBeginFromMeshes) {
  const TemporaryFolder folder;
  write_mesh(folder / "a.vtu", bad_grid());
  const auto model = write_text(folder / "m.toml", "mesh = \"a.vtu\"\nstart = true\n");
  EXPECT_EQ(delquad({"mesh", model, "--pipeline", "O", "-o", folder / "out.msh"}).exit_code, 0);
  EXPECT_EQ(delquad({"info", model}).exit_code, 0);
  const std::string cases = "[[case]]\nname = \"a\"\nmesh = \"a.vtu\"\nstart = true\n";
  const auto file = write_text(folder / "e.toml", "pipelines = [\"CO\", \"O\", \"DB\"]\n" + cases);
  const ProgramResult result = delquad({"run", file, "-o", folder / "results", "--pictures", "none"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(delquad({"rerun", folder / "results/a/CO/record.json"}).exit_code, 0);
  // Words from elements need some.
  const auto mixed = write_text(
      folder / "f.toml", "pipelines = [\"CO\"]\n" + cases + "[[case]]\nname = \"b\"\nsize = 0.1\n" + kSquare);
  const ProgramResult refused = delquad({"run", mixed, "-o", folder / "none"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_TRUE(contains(refused.err, "'C' starts from quads")) << refused.err;
}

/// A part of a cylinder.
Mesh bad_shell() {
  Mesh mesh = bad_grid();
  for (Vec3& p : mesh.points) p = {std::sin(p.x), p.y, std::cos(p.x)};
  mesh.regions = {{2, {"shell"}}};
  return mesh;
}

TEST(ImproveCommand, MeshesInSpace) {
  for (const char* name : {"a.msh", "a.vtu", "a.inp", "a.mesh", "a.obj"}) {
    const TemporaryFolder folder;
    write_mesh(folder / name, bad_shell());
    const ProgramResult result = delquad({"improve", folder / name, "-o", folder / "out.msh"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const std::size_t before = result.out.find("eta mean"), after = result.out.rfind("eta mean");
    EXPECT_LT(std::stod(result.out.substr(before + 9)), 0.9) << name;
    EXPECT_GT(std::stod(result.out.substr(after + 9)), 0.97) << name;
    EXPECT_EQ(read_mesh(folder / "out.msh").quads.size(), 64u);
  }
  const TemporaryFolder folder;
  write_mesh(folder / "a.vtu", bad_shell());
  const auto file = write_text(folder / "e.toml",
                               "pipelines = [\"CO\", \"O\"]\n[[case]]\nname = \"a\"\nmesh = \"a.vtu\"\n"
                               "start = true\n");
  const ProgramResult result = delquad({"run", file, "-o", folder / "results"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(delquad({"rerun", folder / "results/a/CO/record.json"}).exit_code, 0);
  EXPECT_EQ(delquad({"info", write_text(folder / "m.toml", "mesh = \"a.vtu\"\nstart = true\n")}).exit_code,
            0);
}

TEST(ImproveCommand, TornMeshesAreToldAndWelded) {
  const TemporaryFolder folder;
  Mesh mesh = bad_shell();
  for (std::size_t q = 32; q < 64; ++q)  // the upper half gets nodes of its own along the middle
    for (int& v : mesh.quads[q])
      if (v < 45) v += 45;
  for (int v = 36; v < 45; ++v) mesh.points.push_back(mesh.points[v] + Vec3{0, 1e-7, 0});
  write_mesh(folder / "torn.msh", mesh);
  const std::string told = "9 points at open edges coincide with others";
  const auto torn = delquad({"improve", folder / "torn.msh", "-o", folder / "out.msh"});
  EXPECT_TRUE(contains(torn.err, told)) << torn.err;
  EXPECT_TRUE(contains(delquad({"metrics", folder / "torn.msh"}).err, told));
  EXPECT_TRUE(contains(delquad({"convert", folder / "torn.msh", folder / "c.msh"}).err, told));
  EXPECT_EQ(read_mesh(folder / "c.msh").points.size(), 90u);
  const auto model = write_text(folder / "m.toml", "mesh = \"torn.msh\"\nstart = true\n");
  EXPECT_TRUE(contains(delquad({"info", model}).out, told));
  for (const char* command : {"improve", "convert"}) {
    std::vector<std::string> arguments = {command, folder / "torn.msh", "--weld", "1e-6"};
    if (command[0] == 'i') arguments.push_back("-o");
    arguments.push_back(folder / "joined.msh");
    const auto joined = delquad(arguments);
    EXPECT_EQ(joined.exit_code, 0);
    EXPECT_TRUE(contains(joined.err, "welded 9 points")) << joined.err;
    EXPECT_EQ(read_mesh(folder / "joined.msh").points.size(), 81u);
  }
}

TEST(ImproveCommand, WebsAreWeldedToPlates) {
  const TemporaryFolder folder;
  Mesh mesh = bad_shell();
  for (int row = 0; row < 3; ++row)  // a web of 8 x 2 quads stands on the middle line
    for (int i = 0; i < 9; ++i) mesh.points.push_back((1 + 0.2 * row) * mesh.points[36 + i]);
  for (int q = 0; q < 16; ++q) {
    const int v = 81 + q / 8 * 9 + q % 8;
    mesh.quads.push_back({v, v + 1, v + 10, v + 9});
    mesh.quad_region.push_back(0);
  }
  write_mesh(folder / "torn.msh", mesh);
  const auto torn = delquad({"metrics", folder / "torn.msh"});
  EXPECT_TRUE(contains(torn.err, "9 points at open edges coincide with others")) << torn.err;
  const auto joined =
      delquad({"improve", folder / "torn.msh", "--weld", "1e-6", "-o", folder / "joined.msh"});
  ASSERT_EQ(joined.exit_code, 0) << joined.err;
  const Mesh result = read_mesh(folder / "joined.msh");
  EXPECT_EQ(result.points.size(), 81u + 18u);
  int branching = 0;
  for_each_edge(sorted_half_edges(result), [&](const auto& edge) { branching += edge.size() == 3; });
  EXPECT_EQ(branching, 8);
  EXPECT_FALSE(contains(delquad({"metrics", folder / "joined.msh"}).err, "coincide"));
}

}  // namespace
}  // namespace delquad::testing_support
