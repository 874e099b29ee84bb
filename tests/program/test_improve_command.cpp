// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/mesh/half_edges.h"
#include "tests/program/program.h"

namespace delquad::testing_support {
namespace {

/// A grid with a third of its inner points moved.
Mesh bad_grid() {
  Mesh mesh = quad_grid(8, 8);
  for (int v = 0; v < 81; v += 3)
    if (v % 9 != 0 && v % 9 != 8 && v > 8 && v < 72) mesh.points[v] = mesh.points[v] + Vec3{0.07, 0.05, 0};
  return mesh;
}

/// A part of a cylinder.
Mesh bad_shell() {
  Mesh mesh = bad_grid();
  for (Vec3& p : mesh.points) p = {std::sin(p.x), p.y, std::cos(p.x)};
  mesh.regions = {{2, {"shell"}}};
  return mesh;
}

TEST(ImproveCommand, PrintsBeforeAndAfterAndKeepsNames) {
  for (const auto& [bad, best] : {std::pair(bad_grid(), 0.99), {bad_shell(), 0.97}})
    for (const char* name : {"a.msh", "a.vtu", "a.inp", "a.mesh", "a.obj"}) {
      SCOPED_TRACE(name);
      const Workplace folder;
      write_mesh(folder / name, bad);
      const ProgramResult result =
          folder.run("improve " + std::string(name) + " -o out.msh --json record.json");
      ASSERT_EQ(result.exit_code, 0) << result.err;
      EXPECT_TRUE(best < 0.99 || result.err.empty()) << result.err;
      const std::size_t before = result.out.find("eta mean"), after = result.out.rfind("eta mean");
      ASSERT_NE(before, after);
      EXPECT_LT(std::stod(result.out.substr(before + 9)), 0.9);
      EXPECT_GT(std::stod(result.out.substr(after + 9)), best);
      EXPECT_TRUE(holds(read_text(folder / "record.json"), "\"given\": true"));
      const Mesh given = read_mesh(folder / name), better = read_mesh(folder / "out.msh");
      EXPECT_EQ(better.quads.size(), 64u);
      EXPECT_EQ(better.lines.size(), given.lines.size());
      ASSERT_EQ(better.curves.size(), given.curves.size());
      for (std::size_t i = 0; i < given.curves.size(); ++i)
        EXPECT_EQ(better.curves[i].names, given.curves[i].names);
    }
}

TEST(ImproveCommand, TrianglesAreMergedUnlessTheWordIsForQuads) {
  const Workplace folder;
  write_mesh(folder / "t.msh", triangle_grid(6, 6));
  ASSERT_EQ(folder.run("improve t.msh -o out.msh").exit_code, 0);
  EXPECT_EQ(read_mesh(folder / "out.msh").quads.size(), 36u);
  const ProgramResult refused = folder.run("improve t.msh --pipeline CO -o none.msh");
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_TRUE(holds(refused.err, "72 triangles and no quads"));
  EXPECT_FALSE(fs::exists(folder / "none.msh"));
}

TEST(ImproveCommand, ModelsAndExperimentsBeginFromMeshes) {
  const Workplace folder;
  write_text(folder / "m.toml", "mesh = 'a.vtu'\nstart = true\n");
  const std::string cases = "[[case]]\nname = 'a'\nmesh = 'a.vtu'\nstart = true\n";
  write_text(folder / "e.toml", "pipelines = ['CO', 'O', 'DB']\n" + cases);
  write_text(folder / "shell.toml", "pipelines = ['CO', 'O']\n" + cases);
  for (const bool in_space : {false, true}) {
    write_mesh(folder / "a.vtu", in_space ? bad_shell() : bad_grid());
    EXPECT_EQ(folder.run("info m.toml").exit_code, 0);
    if (!in_space) {
      EXPECT_EQ(folder.run("mesh m.toml --pipeline O -o out.msh").exit_code, 0);
    }
    const ProgramResult result =
        folder.run(in_space ? "run shell.toml -o shell" : "run e.toml -o results --pictures none");
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(
        folder.run(in_space ? "rerun shell/a/CO/record.json" : "rerun results/a/CO/record.json").exit_code,
        0);
  }
  // Words from elements need some.
  write_text(folder / "f.toml",
             "pipelines = ['CO']\n" + cases + "[[case]]\nname = 'b'\nsize = 0.1\n" + kSquare);
  const ProgramResult refused = folder.run("run f.toml -o none");
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_TRUE(holds(refused.err, "'C' starts from quads"));
}

TEST(ImproveCommand, TornMeshesAreToldAndWelded) {
  const Workplace folder;
  Mesh mesh = bad_shell();
  for (std::size_t q = 32; q < 64; ++q)  // the upper half gets nodes of its own along the middle
    for (int& v : mesh.quads[q])
      if (v < 45) v += 45;
  for (int v = 36; v < 45; ++v) mesh.points.push_back(mesh.points[v] + Vec3{0, 1e-7, 0});
  write_mesh(folder / "torn.msh", mesh);
  write_text(folder / "m.toml", "mesh = 'torn.msh'\nstart = true\n");
  for (const char* words :
       {"improve torn.msh -o out.msh", "metrics torn.msh", "convert torn.msh c.msh", "info m.toml"}) {
    const ProgramResult torn = folder.run(words);
    EXPECT_TRUE(holds(words[1] == 'n' ? torn.out : torn.err, "9 points at open edges coincide with others"))
        << words << torn.out << torn.err;
  }
  EXPECT_EQ(read_mesh(folder / "c.msh").points.size(), 90u);
  for (const char* words :
       {"improve torn.msh --weld 1e-6 -o joined.msh", "convert torn.msh --weld 1e-6 joined.msh"}) {
    const ProgramResult joined = folder.run(words);
    EXPECT_EQ(joined.exit_code, 0);
    EXPECT_TRUE(holds(joined.err, "welded 9 points"));
    EXPECT_EQ(read_mesh(folder / "joined.msh").points.size(), 81u);
  }
}

TEST(ImproveCommand, WebsAreWeldedToPlates) {
  const Workplace folder;
  Mesh mesh = bad_shell();
  for (int row = 0; row < 3; ++row)  // a web of 8 x 2 quads stands on the middle line
    for (int i = 0; i < 9; ++i) mesh.points.push_back((1 + 0.2 * row) * mesh.points[36 + i]);
  for (int q = 0; q < 16; ++q) {
    const int v = 81 + q / 8 * 9 + q % 8;
    mesh.quads.push_back({v, v + 1, v + 10, v + 9});
    mesh.quad_region.push_back(0);
  }
  write_mesh(folder / "torn.msh", mesh);
  const ProgramResult torn = folder.run("metrics torn.msh");
  EXPECT_TRUE(holds(torn.err, "9 points at open edges coincide with others"));
  const ProgramResult joined = folder.run("improve torn.msh --weld 1e-6 -o joined.msh");
  ASSERT_EQ(joined.exit_code, 0) << joined.err;
  const Mesh result = read_mesh(folder / "joined.msh");
  EXPECT_EQ(result.points.size(), 81u + 18u);
  int branching = 0;
  for_each_edge(sorted_half_edges(result), [&](const auto& edge) { branching += edge.size() == 3; });
  EXPECT_EQ(branching, 8);
  EXPECT_FALSE(holds(folder.run("metrics joined.msh").err, "coincide"));
}

}  // namespace
}  // namespace delquad::testing_support
