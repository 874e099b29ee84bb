#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <numbers>

#include "tests/program/program.h"

namespace delquad::testing_support {
namespace {

int lines_in(const std::string& text) { return static_cast<int>(std::ranges::count(text, '\n')); }

/// A hexagonal prism of sides 1 and height 20 as OFF: at a size of 5 its twelve short edges are all warned
/// of.
std::string prism(bool open) {
  std::string points, faces;
  for (const double z : {0.0, 20.0})
    for (int k = 0; k < 6; ++k) {
      const double angle = k * std::numbers::pi / 3;
      points += std::to_string(std::cos(angle)) + " " + std::to_string(std::sin(angle)) + " " +
                std::to_string(z) + "\n";
    }
  int n = 0;
  const auto add = [&](int a, int b, int c) {
    faces += "3 " + std::to_string(a) + " " + std::to_string(b) + " " + std::to_string(c) + "\n";
    ++n;
  };
  for (int k = 0; k < 6; ++k) {
    add(k, (k + 1) % 6, 6 + (k + 1) % 6);
    add(k, 6 + (k + 1) % 6, 6 + k);
  }
  for (int k = 1; k < 5; ++k) {
    add(0, k + 1, k);
    if (!open) add(6, 6 + k, 6 + k + 1);
  }
  return "OFF\n12 " + std::to_string(n) + " 0\n" + points + faces;
}

TEST(Habits, VersionAndHelp) {
  const ProgramResult version = delquad({"--version"});
  EXPECT_EQ(version.exit_code, 0);
  EXPECT_TRUE(version.out.starts_with("delquad ")) << version.out;
  EXPECT_TRUE(contains(version.out, "commit ")) << version.out;
  EXPECT_EQ(lines_in(version.out), 1);
  const ProgramResult all = delquad({"--version", "-v"});
  for (const char* library : {"opencascade", "cgal", "ceres"})
    EXPECT_TRUE(contains(all.out, library)) << all.out;

  EXPECT_EQ(delquad({"help"}).out, delquad({"--help"}).out);
  const ProgramResult help = delquad({"help", "mesh"});
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_EQ(help.out, delquad({"mesh", "--help"}).out);
  for (const char* code : {"0:", "1:", "2:", "3:", "4:", "5:", "130:", "143:"})
    EXPECT_TRUE(contains(help.out, code)) << code;
  const ProgramResult unknown = delquad({"help", "mush"});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_TRUE(contains(unknown.err, "'mush'") && contains(unknown.err, "mesh")) << unknown.err;
}

TEST(Habits, SlipsAreToldInTheOrderInWhichTheyWereTyped) {
  for (const auto& [words, said] : std::vector<std::pair<std::vector<std::string>, std::string>>{
           {{"mehs", "a.toml"}, "not expected: 'mehs' (did you mean 'mesh'?), 'a.toml' ("},
           {{"mesh", "a.toml", "--sise=0.1", "--xyzzy", "3", "-o", "b.msh"},
            "not expected: '--sise=0.1' (did you mean '--size'?), '--xyzzy', '3' ("},
           {{"mesh", "a.toml", "--outptu", "b.msh"}, "'--outptu' (did you mean '--output'?), 'b.msh' ("},
           {{"--verison"}, "'--verison' (did you mean '--version'?)"},
           {{"mesh", "a.toml"}, "--output is required"},
           {{"help", "mush"}, "did you mean 'mesh'?"},
           {{"mesh", "a.toml", "-o", "b.vtuu"}, "did you mean '.vtu'?"}}) {
    const ProgramResult result = delquad(words);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_TRUE(contains(result.err, said)) << result.err;
  }
}

TEST(Habits, QuietPrintsErrorsOnly) {
  const TemporaryFolder folder;
  const std::string model = write_text(folder / "prism.off", prism(true)), out = folder / "out.msh";
  for (const auto& words :
       std::vector<std::vector<std::string>>{{"-q", "mesh", model, "-o", out, "--size", "5"},
                                             {"mesh", "--quiet", model, "-o", out, "--size", "5"}}) {
    const ProgramResult result = delquad(words);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.out + result.err, "");
    EXPECT_TRUE(std::filesystem::remove(out));
  }
  const ProgramResult bad = delquad({"mesh", "-q", model, "-o", out, "--size", "-1"});
  EXPECT_EQ(bad.exit_code, 2);
  EXPECT_EQ(lines_in(bad.err), 1) << bad.err;
  EXPECT_FALSE(delquad({"schema", "-q"}).out.empty()) << "all that it does is print";
}

TEST(Habits, WarningsOfAKindAreOneLine) {
  const TemporaryFolder folder;
  const std::string model = write_text(folder / "prism.off", prism(false));
  const std::vector<std::string> words = {
      "mesh", model, "-o", folder / "out.msh", "--json", folder / "out.json", "--size", "5"};
  const ProgramResult result = delquad(words);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(contains(result.err, "warning: 12 curves shorter than 0.5 times the size; the worst: curve "))
      << result.err;
  EXPECT_EQ(lines_in(result.err), 1) << result.err;
  EXPECT_EQ(nlohmann::json::parse(read_text(folder / "out.json")).at("warnings").size(), 12u);
  auto all = words;
  all.push_back("-v");
  EXPECT_EQ(lines_in(delquad(all).err), 12);
}

TEST(Habits, OpenEdgesOfATriangulationAreTold) {
  const TemporaryFolder folder;
  const std::string open = write_text(folder / "open.off", prism(true)),
                    closed = write_text(folder / "closed.off", prism(false));
  EXPECT_TRUE(contains(delquad({"mesh", open, "-o", folder / "out.msh", "--size", "1"}).err,
                       "warning: the surface is open: free curves: 6 ("));
  EXPECT_TRUE(contains(delquad({"info", open}).out, "the surface is open: free curves: 6 ("));
  EXPECT_EQ(delquad({"mesh", closed, "-o", folder / "out.msh", "--size", "1"}).err, "");
}

TEST(Habits, SizesThatAreEmptyOrTooLargeAreTold) {
  const TemporaryFolder folder;
  const std::string model = write_text(folder / "model.toml", kSquare + "size = 0.5\n"),
                    out = folder / "out.msh";
  for (const auto& words : std::vector<std::vector<std::string>>{{"mesh", model, "-o", out, "--size", ""},
                                                                 {"info", model, "--size", ""}}) {
    const ProgramResult result = delquad(words);
    EXPECT_EQ(result.exit_code, 2) << words[0];
    EXPECT_TRUE(contains(result.err, "--size")) << result.err;
  }
  const ProgramResult fits = delquad({"mesh", model, "-o", out});
  EXPECT_EQ(fits.exit_code, 0) << fits.err;
  EXPECT_EQ(fits.err, "");
  EXPECT_EQ(delquad({"metrics", out, "--size", ""}).exit_code, 2);
  const ProgramResult large = delquad({"mesh", model, "-o", out, "--size", "1.5"});
  EXPECT_EQ(large.exit_code, 0) << large.err;
  EXPECT_TRUE(contains(large.err, "the size, 1.5, is larger than the model, whose diagonal is 1.414"))
      << large.err;
  const std::string solid = write_text(folder / "prism.off", prism(false));
  EXPECT_TRUE(contains(delquad({"mesh", solid, "-o", out, "--size", "30"}).err, "larger than the model"));
  EXPECT_TRUE(contains(delquad({"info", solid, "--size", "30"}).out, "larger than the model"));
}

/// The square with round holes.
std::string write_holes(const TemporaryFolder& folder,
                        const std::vector<std::array<std::string, 3>>& names_centres_radii) {
  std::string text = kSquareLoop;
  for (const auto& [name, centre, radius] : names_centres_radii)
    text += "[[loop]]\ncircle = { centre = " + centre + ", radius = " + radius + " }\nboundary = \"" + name +
            "\"\n";
  return write_text(folder / "model.toml", text);
}

TEST(Habits, CirclesWithFewEdgesAreTold) {
  const TemporaryFolder folder;
  const std::string model =
      write_holes(folder, {{"small", "[0.3, 0.5]", "0.1"}, {"large", "[0.7, 0.5]", "0.12"}});
  const auto mesh = [&](const char* size) {
    return delquad({"mesh", model, "-o", folder / "out.msh", "--size", size}).err;
  };
  EXPECT_TRUE(
      contains(mesh("0.1"), "2 curves get fewer than 12 edges to a full turn, the fewest 6 ('small')"))
      << mesh("0.1");
  EXPECT_TRUE(contains(mesh("0.1"), "--curvature 12 would help")) << mesh("0.1");
  EXPECT_EQ(lines_in(mesh("0.1")), 1) << mesh("0.1");
  EXPECT_EQ(delquad({"mesh", model, "-o", folder / "out.msh", "--size", "0.1", "--curvature", "12"}).err, "");
  EXPECT_EQ(mesh("0.05"), "");
}

TEST(Habits, TouchingHolesAreRefused) {
  const TemporaryFolder folder;
  const std::string model =
      write_holes(folder, {{"left hole", "[0.3, 0.5]", "0.1"}, {"right hole", "[0.5, 0.5]", "0.1"}});
  const ProgramResult result = delquad({"mesh", model, "-o", folder / "out.msh", "--size", "0.03"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_TRUE(contains(result.err, "'left hole'") && contains(result.err, "touch at (0.4, 0.5"))
      << result.err;
  EXPECT_EQ(lines_in(result.err), 1) << result.err;
}

TEST(Habits, MeshesCanBeCompared) {
  const TemporaryFolder folder;
  const std::string model = write_text(folder / "model.toml", kSquare);
  const std::string good = folder / "good.msh", bad = folder / "bad.msh";
  ASSERT_EQ(delquad({"mesh", model, "-o", good, "--size", "0.1"}).exit_code, 0);
  ASSERT_EQ(delquad({"mesh", model, "-o", bad, "--size", "0.1", "--pipeline", "FB"}).exit_code, 0);
  EXPECT_EQ(delquad({"compare", good, good}).exit_code, 0);
  const ProgramResult worse = delquad({"compare", good, bad});
  EXPECT_EQ(worse.exit_code, 1) << worse.out;
  EXPECT_TRUE(contains(worse.out, "eta_mean")) << worse.out;
  EXPECT_EQ(delquad({"compare", good, folder / "none.msh"}).exit_code, 2);
}

}  // namespace
}  // namespace delquad::testing_support
