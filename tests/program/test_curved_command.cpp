#include <gtest/gtest.h>

#include "io/mesh_io.h"
#include "tests/program/program.h"
#include "tests/support/curved_grid.h"

namespace delquad::testing_support {
namespace {

double value_after(const std::string& text, const std::string& key) {
  const std::size_t at = text.find(key);
  return at == std::string::npos ? NAN : std::stod(text.substr(at + key.size()));
}

TEST(CurvedCommand, MetricsAreThoseOfTheRun) {
  const TemporaryFolder folder;
  write_text(folder / "disc.toml", "loop = { circle = { centre = [0, 0], radius = 1 } }\nsize = 0.3\n");
  for (const char* order : {"2", "3", "4"}) {
    ASSERT_EQ(delquad({"mesh", folder / "disc.toml", "-o", folder / "a.msh", "--order", order, "--json",
                       folder / "a.json"})
                  .exit_code,
              0);
    const ProgramResult result = delquad({"metrics", folder / "a.msh", "--json", folder / "m.json"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const std::string run = read_text(folder / "a.json"), metrics = read_text(folder / "m.json");
    EXPECT_EQ(value_after(metrics, "\"order\": "), std::stod(order));
    EXPECT_EQ(value_after(metrics, "\"proven_jacobian_min\": "), value_after(run, "\"least_jacobian\": "));
    EXPECT_NEAR(value_after(metrics, "\"proven_jacobian_mean\": "), value_after(run, "\"mean_jacobian\": "),
                1e-12);
    EXPECT_EQ(value_after(metrics, "\"n_unproven\": "), 0);
    EXPECT_GT(value_after(result.out, "scaled J"), 0.2) << result.out;
    EXPECT_TRUE(contains(result.out, "least proven")) << result.out;
  }
}

TEST(CurvedCommand, ElementsThatAreNotProvenAreCounted) {
  const TemporaryFolder folder;
  Mesh mesh = curved_grid(3, 3, 2, false);
  mesh.points[nodes_of_quad(mesh, 4)[4]] = mesh.points[mesh.quads[4][0]];  // the middle in a corner
  write_mesh(folder / "a.vtu", mesh);
  const ProgramResult result = delquad({"metrics", folder / "a.vtu"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(value_after(result.out, "unproven"), 1) << result.out;
}

TEST(CurvedCommand, WhatNeedsStraightQuadsRefusesOthers) {
  const TemporaryFolder folder;
  write_mesh(folder / "a.msh", curved_grid(3, 3, 2, false));
  write_mesh(folder / "space.msh", curved_grid(3, 3, 2, true));
  const std::string flat = folder / "a.msh", out = folder / "out.msh";
  for (const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{
           {"improve", flat, "-o", out},
           {"improve", folder / "space.msh", "-o", out},
           {"mesh", flat, "--size", "0.1", "-o", out},
           {"mesh", folder / "space.msh", "--size", "0.1", "-o", out},
           {"extrude", flat, "--along", "0,0,1", "--layers", "2", "-o", out},
           {"metrics", flat, "--links"},
           {"metrics", flat, "--solve", "poisson"}}) {
    const ProgramResult result = delquad(arguments);
    EXPECT_EQ(result.exit_code, 2) << arguments[0];
    EXPECT_TRUE(contains(result.err, "order 2")) << result.err;
    EXPECT_TRUE(contains(result.err, "order 1")) << result.err;
  }
  EXPECT_FALSE(std::filesystem::exists(out));
}

TEST(CurvedCommand, SerendipityLeavesMiddlesOut) {
  const TemporaryFolder folder;
  write_text(folder / "disc.toml", "loop = { circle = { centre = [0, 0], radius = 1 } }\nsize = 0.5\n");
  const auto run = [&](const char* name, const char* order) {
    return delquad({"mesh", folder / "disc.toml", "-o", folder / name, "--order", order, "--serendipity"});
  };
  ASSERT_EQ(run("a.vtu", "2").exit_code, 0);
  EXPECT_EQ(read_mesh(folder / "a.vtu").order, 2);
  for (const auto& [name, order] : {std::pair{"b.msh", "3"}, {"b.msh", "1"}, {"b.vtk", "2"}}) {
    const ProgramResult result = run(name, order);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_TRUE(contains(result.err, "8 nodes")) << result.err;
    EXPECT_FALSE(std::filesystem::exists(folder / name));
  }
}

TEST(MeshCommand, TellsNamesThatTheFileCannotHold) {
  const TemporaryFolder folder;
  std::string square = kSquare;
  square.replace(square.find("left"), 4, "in out");
  write_text(folder / "a.toml", square + "size = 0.5\n");
  const ProgramResult result = delquad({"mesh", folder / "a.toml", "-o", folder / "a.vtk"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_TRUE(contains(result.err, "curve \"in out\" is in_out")) << result.err;
}

}  // namespace
}  // namespace delquad::testing_support
