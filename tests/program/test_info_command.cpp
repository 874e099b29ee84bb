#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "delquad/mesh.h"
#include "tests/program/program.h"
#include "tests/support/temporary_folder.h"

namespace delquad::testing_support {
namespace {

std::string text_of(const std::filesystem::path& path) {
  std::ifstream in(path);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

TEST(InfoCommand, TellsOfAPlanarModel) {
  const TemporaryFolder folder;
  std::ofstream(folder / "square.toml")
      << kSquareLoop << "[[loop]]\npolygon = [[0.2, 0.2], [0.8, 0.2], [0.5, 0.21]]\n";
  const auto run = delquad({"info", folder / "square.toml", "--size", "0.5", "--json", folder / "info.json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  for (const char* part : {"1 shell, 1 face, 7 curves, 7 vertices", "annulus", "outline      5.2",
                           "smaller than the size 0.5", "curves  6, 7"})
    EXPECT_TRUE(contains(run.out, part)) << part << "\n" << run.out;
  const std::string json = text_of(folder / "info.json");
  for (const char* part :
       {"\"topology\": \"annulus\"", "\"names\": [\n        \"bottom\"", "\"kind\": \"free\""})
    EXPECT_TRUE(contains(json, part)) << part << "\n" << json;
}

TEST(InfoCommand, TellsOfTrianglesAndTheirRepair) {
  const TemporaryFolder folder;
  // A needle of 2 degrees beside a right-angled triangle; one triangle stands twice.
  std::ofstream(folder / "needle.off")
      << "OFF\n4 3 0\n0 0 0\n10 0 0\n10 0.35 0\n10 0 5\n3 0 1 2\n3 0 3 1\n3 1 2 0\n";
  const auto run = delquad({"info", folder / "needle.off"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  for (const char* part : {"2 faces", "sharp corners (degrees)", "2.00  face 1, between curves",
                           "left out 1 triangle on the vertices of another"})
    EXPECT_TRUE(contains(run.out, part)) << part << "\n" << run.out;
}

TEST(InfoCommand, WritesTheFeaturesThatItFinds) {
  const TemporaryFolder folder;
  // Two triangles at a right angle: the edge between them is a feature.
  std::ofstream(folder / "angle.off") << "OFF\n4 2 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 1 2\n3 1 0 3\n";
  const auto run = delquad({"info", folder / "angle.off", "-o", folder / "parts.msh"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Mesh parts = read_mesh(folder / "parts.msh");
  EXPECT_EQ(parts.regions.size(), 2u);
  EXPECT_EQ(parts.curves.size(), 5u) << "two sides of each face, between three corners, and the edge";
  EXPECT_EQ(parts.lines.size(), 5u);
}

TEST(InfoCommand, LongListsAreShortened) {
  const TemporaryFolder folder;
  std::ofstream(folder / "plate.toml")
      << kSquareLoop
      << "[[pattern]]\nrectangle = [[0.01, 0.01], [0.05, 0.05]]\ncount = [9, 9]\nstep = [0.1, 0.1]\n";
  const auto run = delquad({"info", folder / "plate.toml"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_TRUE(contains(run.out, "... and 308 more (--json has all)")) << run.out;
  EXPECT_TRUE(contains(run.out, "disk with 81 holes")) << run.out;
}

TEST(InfoCommand, BadInput) {
  const TemporaryFolder folder;
  std::ofstream(folder / "square.toml") << kSquare;
  std::ofstream(folder / "a.stl") << "solid\n";
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
      {{"info", folder / "none.step"}, "none.step"},
      {{"info", folder / "a.stl"}, "a.stl"},
      {{"info", folder / "a.doc"}, "unknown kind of model"},
      {{"info", folder / "square.toml", "--size", "0"}, "--size 0: expected"},
      {{"info", folder / "square.toml", "--size", "x"}, "--size x: expected"},
      {{"info", folder / "square.toml", "--json", folder / "square.toml"}, "the same file"},
      {{"info", folder / "square.toml", "-o", folder / "square.toml"}, "the same file"},
      {{"info", folder / "square.toml", "-o", folder / "parts.doc"}, "parts.doc"},
      {{"info", folder / "square.toml", "--json", folder / "no/where.json"}, "there is no folder"}};
  for (const auto& [arguments, part] : cases) {
    const auto run = delquad(arguments);
    EXPECT_EQ(run.exit_code, 2) << part;
    EXPECT_TRUE(contains(run.err, part)) << run.err;
    EXPECT_EQ(run.out, "");
  }
  EXPECT_EQ(text_of(folder / "square.toml"), kSquare);
}

}  // namespace
}  // namespace delquad::testing_support
