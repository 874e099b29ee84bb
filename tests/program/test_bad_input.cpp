#include <gtest/gtest.h>

#include <algorithm>
#include <ostream>

#include "io/mesh_formats.h"
#include "tests/program/program.h"
#include "tests/support/needs_file.h"

namespace delquad::testing_support {
namespace {

/// A refusal: exit code 2, one line that says `part`, and nothing written.
void expect_refusal(const ProgramResult& result, const std::vector<std::string>& parts) {
  EXPECT_EQ(result.exit_code, 2) << result.err;
  EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
  EXPECT_TRUE(contains(result.err, "error: ")) << result.err;
  EXPECT_FALSE(contains(result.err, "internal")) << result.err;
  for (const std::string& part : parts)
    EXPECT_TRUE(contains(result.err, part)) << "'" << part << "' is not in: " << result.err;
}

struct BadModel {
  const char* name;
  std::string text;
  std::vector<std::string> parts;  ///< of the message
};

void PrintTo(const BadModel& model, std::ostream* out) { *out << model.name; }

class BadModels : public testing::TestWithParam<BadModel> {};

TEST_P(BadModels, AreRefusedWithOneMessage) {
  const TemporaryFolder folder;
  const auto model = write_text(folder / "model.toml", GetParam().text);
  expect_refusal(delquad({"mesh", model, "-o", folder / "out.msh", "--size", "0.1"}), GetParam().parts);
  EXPECT_EQ(folder.names(), std::vector<std::string>{"model.toml"});
}

const BadModel kModels[] = {
    {"not_toml", "loop = {", {"model.toml:1", "not TOML"}},
    {"binary", std::string("\x00\xff\xfe\x01", 4), {"model.toml:1", "not TOML"}},
    {"empty", "", {"model.toml", "no model"}},
    {"misspelt_key",
     "lop = { rectangle = [[0, 0], [1, 1]] }",
     {"model.toml:1", "unknown key 'lop'", "'loop'"}},
    {"misspelt_shape",
     "[[loop]]\nrectangel = [[0, 0], [1, 1]]",
     {"model.toml:2", "unknown key 'loop.rectangel'", "'rectangle'"}},
    {"wrong_type",
     "[[loop]]\ncircle = { centre = [0, 0], radius = \"1\" }",
     {"model.toml:2", "radius", "finite number"}},
    {"nan_coordinate", "[[loop]]\npolygon = [[0, 0], [1, nan], [1, 1]]", {"model.toml:2", "points"}},
    {"two_shapes",
     "[[loop]]\ncircle = { centre = [0, 0], radius = 1 }\nrectangle = [[0, 0], [1, 1]]",
     {"model.toml", "exclude each other"}},
    {"flat_rectangle", "[[loop]]\nrectangle = [[0, 0], [1, 0]]", {"model.toml:2", "no area"}},
    {"two_corners", "[[loop]]\npolygon = [[0, 0], [1, 0]]", {"model.toml:2", "three corners"}},
    {"boundary_of_curves",
     "[[curve]]\nname = \"wall\"\ncircle = { centre = [0, 0], radius = 1 }\n[[loop]]\ncurves = [\"wall\"]\n"
     "boundary = \"rim\"",
     {"model.toml:6", "'boundary'", "at the curves themselves"}},
    {"unknown_curve",
     "[[curve]]\nname = \"wall\"\ncircle = { centre = [0, 0], radius = 1 }\n[[loop]]\ncurves = [\"wal\"]",
     {"model.toml:5", "'wal'", "'wall'"}},
    {"unused_curve",
     kSquare + "[[curve]]\nname = \"wall\"\nsegment = [[0, 0], [1, 1]]",
     {"model.toml:2", "'wall'"}},
    {"bad_expression",
     "[[curve]]\nname = \"c\"\nexpression = { x = \"cos(\", y = \"0\", from = 0, to = 1 }",
     {"model.toml", "cos("}},
    {"self_intersecting", "[[loop]]\npolygon = [[0, 0], [1, 1], [1, 0], [0, 1]]", {"0.5"}},
    {"zero_length", "[[loop]]\npolygon = [[0, 0], [0, 0], [1, 0], [1, 1]]", {"model.toml:1"}},
    {"open",
     "[[curve]]\nname = \"a\"\nsegment = [[0, 0], [1, 0]]\n[[curve]]\nname = \"b\"\nsegment = [[1, 0], [1, "
     "1]]\n"
     "[[loop]]\ncurves = [\"a\", \"b\"]",
     {"model.toml"}},
    {"duplicate",
     kSquareLoop + "[[loop]]\nrectangle = [[0, 0], [1, 1]]\nregion = \"again\"",
     {"model.toml:5", "same curves"}},
    {"touching",
     kSquareLoop + "[[loop]]\ncircle = { centre = [0.5, 0.25], radius = 0.25 }",
     {"model.toml:5", "touch"}},
    {"crossing_loops",
     kSquareLoop + "[[loop]]\nrectangle = [[0.5, 0.25], [1.5, 0.75]]",
     {"model.toml:5", "(1, 0."}},
    {"quote_in_name",
     "[[loop]]\nrectangle = [[0, 0], [1, 1]]\nboundary = 'a\"b'",
     {"model.toml:3", "'boundary'", "double quotes"}},
    {"line_break_in_name",
     "[[loop]]\nrectangle = [[0, 0], [1, 1]]\nregion = \"a\\nb\"",
     {"model.toml:3", "'region'", "line breaks"}},
    {"h_max_too_small",
     kSquareLoop + "[insertion]\nh_max = 1.05",
     {"model.toml:6", "'insertion.h_max'", "from 1.1 to 3"}},
    {"h_max_too_large",
     kSquareLoop + "[insertion]\nh_max = 4",
     {"model.toml:6", "'insertion.h_max'", "from 1.1 to 3"}},
    {"rejection_of_everything",
     kSquareLoop + "[insertion]\nrejection = 1",
     {"model.toml:6", "'insertion.rejection'", "above 0 and at most 0.95"}},
    {"hole_outside",
     kSquareLoop + "[[loop]]\ncircle = { centre = [3, 0], radius = 0.5 }\nhole = true",
     {"model.toml:5", "hole", "outside"}},
};
INSTANTIATE_TEST_SUITE_P(Toml, BadModels, testing::ValuesIn(kModels),
                         [](const auto& model) { return std::string(model.param.name); });

struct BadSize {
  const char *name, *size;
  std::vector<std::string> parts;  ///< of the message
};
void PrintTo(const BadSize& bad, std::ostream* out) { *out << bad.name; }

class BadSizes : public testing::TestWithParam<BadSize> {};

TEST_P(BadSizes, AreRefusedWithOneMessage) {
  const TemporaryFolder folder;
  const auto model = write_text(folder / "model.toml", kSquare);
  expect_refusal(delquad({"mesh", model, "-o", folder / "out.msh", "--size", GetParam().size}),
                 GetParam().parts);
  EXPECT_EQ(folder.names(), std::vector<std::string>{"model.toml"});
}

const std::string kLongFormula = "0.1" + [] {
  std::string text;
  for (int i = 0; i < 1000; ++i) text += " + 0*x";
  return text;
}();
const std::string kLongMistake = kLongFormula + " + q";

const BadSize kSizes[] = {
    {"zero", "0", {"--size", "> 0"}},
    {"negative", "-0.1", {"--size", "> 0"}},
    {"nan", "nan", {"> 0"}},
    {"infinite", "inf", {"> 0"}},
    {"open_bracket", "0.1*(x", {"--size", "position"}},
    {"unknown_variable", "0.1*q", {"'q'"}},
    {"misspelt_word", "boundry", {"did you mean 'boundary'?"}},
    {"negative_somewhere", "0.1*(x - 0.5)", {"--size: ", "positive"}},
    // Wrong in the middle only, which no boundary node sees.
    {"negative_inside", "0.1*((x-0.5)^2 + (y-0.5)^2 - 0.01)", {"--size: ", "positive"}},
    {"no_edges", "boundary", {"no edge lengths"}},
    {"small", "1e-5", {"about 1e+10 quads"}},
    {"smallest", "1e-200", {"more quads than can be counted", "max-elements"}},
    {"long", kLongMistake.c_str(), {"...", "'q'", "position 6007"}},
};
INSTANTIATE_TEST_SUITE_P(OnASquare, BadSizes, testing::ValuesIn(kSizes),
                         [](const auto& bad) { return std::string(bad.param.name); });

TEST(BadFields, EvaluationFailuresSayWhereTheyWereWritten) {
  const TemporaryFolder folder;
  const auto model =
      write_text(folder / "model.toml", kSquare + "size = \"0.1*(x - 0.5)\"\ncross = \"0/(x - x)\"\n");
  const auto mesh = [&](std::vector<std::string> more) {
    std::vector<std::string> arguments = {"mesh", model, "-o", folder / "out.msh"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return delquad(arguments);
  };
  expect_refusal(mesh({}), {"model.toml:2: size field"});
  expect_refusal(mesh({"--size", "0.1"}), {"model.toml:3: cross field"});
  expect_refusal(mesh({"--size", "0.1", "--cross", "1/(x - x)"}), {"error: --cross: cross field"});
  expect_refusal(mesh({"--size", "0.1", "--cross", "boundry"}), {"did you mean 'boundary'?"});
  const ProgramResult result = mesh({"--size", kLongMistake});
  EXPECT_LT(result.err.size(), 300u);
}

struct BadMesh {
  const char* name;
  std::string text;
};
void PrintTo(const BadMesh& mesh, std::ostream* out) { *out << mesh.name; }

class BadMeshes : public testing::TestWithParam<BadMesh> {};

TEST_P(BadMeshes, AreRefusedWithOneMessage) {
  const TemporaryFolder folder;
  const auto model = write_text(folder / "lines.msh", GetParam().text);
  expect_refusal(delquad({"mesh", model, "-o", folder / "out.msh"}), {"lines.msh"});
  EXPECT_EQ(folder.names(), std::vector<std::string>{"lines.msh"});
}

const std::string kTriangle = line_mesh({{0, 0}, {1, 0}, {0, 1}}, "rim");
const BadMesh kMeshes[] = {
    {"empty", ""},
    {"garbage", std::string("\x7f\x45\x4c\x46\x00\xff", 6)},
    {"truncated", kTriangle.substr(0, kTriangle.size() / 2)},
    {"no_lines", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n0\n$EndNodes\n$Elements\n0\n$EndElements\n"},
    {"two_nodes", line_mesh({{0, 0}, {1, 0}}, "rim")},
    {"coincident_nodes", line_mesh({{0, 0}, {1, 0}, {1, 0}, {0, 1}}, "rim")},
    {"bow_tie", line_mesh({{0, 0}, {1, 1}, {1, 0}, {0, 1}}, "rim")},
    {"quote_in_name", line_mesh({{0, 0}, {1, 0}, {0, 1}}, "r\"im")},
};
INSTANTIATE_TEST_SUITE_P(Msh, BadMeshes, testing::ValuesIn(kMeshes),
                         [](const auto& model) { return std::string(model.param.name); });

TEST(BadArguments, AreRefused) {
  const TemporaryFolder folder;
  const std::string model = write_text(folder / "model.toml", kSquare), out = folder / "out.msh";
  const auto mesh = [&](std::vector<std::string> more) {
    std::vector<std::string> arguments = {"mesh", model, "-o", out, "--size", "0.1"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return delquad(arguments);
  };
  expect_refusal(mesh({"--pipeline", "DX"}), {"'X'", "F (", "D (", "B ("});
  expect_refusal(mesh({"--pipeline", "BD"}), {"'BD'"});
  expect_refusal(mesh({"--pipeline", ""}), {"empty pipeline"});
  expect_refusal(mesh({"--quality", "superb"}), {"'superb'", "fast, good, best, regular"});
  expect_refusal(mesh({"--cross", "sin("}), {"--cross", "sin("});
  expect_refusal(mesh({"--json", folder / "nowhere" / "record.json"}), {"nowhere"});
  expect_refusal(mesh({"--max-elements", "50"}), {"about 100 quads", "50"});
  EXPECT_EQ(mesh({"--pipeline", "F", "--max-elements", "1e6"}).exit_code, 0);
  std::filesystem::remove(out);
  for (const char* count : {"0", "-1", "1.5", "many", "1e30"}) {
    const ProgramResult result = mesh({"--max-elements", count});
    EXPECT_EQ(result.exit_code, 2) << count;
    EXPECT_TRUE(contains(result.err, "whole number from 1 to 1e15")) << result.err;
  }
  expect_refusal(delquad({"mesh", model, "-o", folder / "out.stl", "--size", "0.1"}),
                 {".stl",
                  ".msh, .vtu, .obj, .inp, .mesh, .vtk, .e, .cgns, .med, .xdmf, .mfem, .su2, .bdf, .unv, .k, "
                  ".2dm, .gr3, .nc, .ism, .abq, .re2, "
                  ".specfem, .foam or .svg"});
  expect_refusal(delquad({"mesh", model, "-o", folder / "nowhere" / "out.msh", "--size", "0.1"}),
                 {"nowhere"});
  expect_refusal(delquad({"mesh", folder / "model.sat", "-o", out, "--size", "0.1"}),
                 {".sat", ".toml", ".msh"});
  expect_refusal(delquad({"mesh", folder / "none.toml", "-o", out, "--size", "0.1"}),
                 {"none.toml", "No such file"});
  expect_refusal(delquad({"metrics", folder / "none.msh"}), {"none.msh", "No such file"});
  expect_refusal(delquad({"run", model, "-o", folder / "results"}), {"model.toml", "no cases"});
  EXPECT_EQ(folder.names(), std::vector<std::string>{"model.toml"});
}

TEST(BadArguments, UsageErrorsHaveTheSameExitCode) {
  EXPECT_EQ(delquad({}).exit_code, 2);
  EXPECT_EQ(delquad({"mesh"}).exit_code, 2);
  EXPECT_EQ(delquad({"mush"}).exit_code, 2);
  EXPECT_EQ(delquad({"mesh", "a.toml", "-o", "b.msh", "--sise", "1"}).exit_code, 2);
  EXPECT_EQ(delquad({"--help"}).exit_code, 0);
  const auto unknown = delquad({"mesh", "a.toml", "-o", "b.msh", "--sise", "1"});
  EXPECT_TRUE(unknown.err.starts_with("error: ")) << unknown.err;
  EXPECT_NE(unknown.err.find("--sise"), std::string::npos) << unknown.err;
}

TEST(BadArguments, ExperimentGivenAsModelIsNamed) {
  const TemporaryFolder folder;
  const auto file = write_text(folder / "e.toml", "[[case]]\nname = \"a\"\n" + kSquare);
  expect_refusal(delquad({"mesh", file, "-o", folder / "out.msh", "--size", "0.1"}),
                 {"e.toml:1", "delquad run"});
}

/// Files that are the same one, by whatever name, are refused before work, and stay as they are.
TEST(Output, SameFileTwiceIsRefused) {
  const TemporaryFolder folder;
  const auto model = write_text(folder / "ring.msh", kTriangle);
  const std::string text = read_text(model);
  std::filesystem::create_symlink("ring.msh", folder / "link.msh");
  std::filesystem::create_symlink("new.msh", folder / "dangling.msh");
  std::filesystem::create_hard_link(model, folder / "hard.msh");
  const auto before = folder.names();
  const std::string dotted = (folder.path() / "." / "ring.msh").string();
  for (const std::string& same :
       {model.string(), dotted, (folder / "link.msh").string(), (folder / "hard.msh").string()}) {
    expect_refusal(delquad({"mesh", model, "-o", same}), {"same file", "the model"});
    expect_refusal(delquad({"mesh", model, "-o", folder / "out.msh", "--json", same}), {"same file"});
    expect_refusal(delquad({"metrics", model, "--json", same}), {"same file", "the mesh"});
  }
  for (const char* same : {"new.msh", "./new.msh", "dangling.msh"})
    expect_refusal(delquad({"mesh", model, "-o", folder / "new.msh", "--json", folder.path() / same}),
                   {"--json", "same file as -o"});
  EXPECT_EQ(read_text(model), text);
  EXPECT_EQ(folder.names(), before);
}

TEST(Output, ThroughDanglingLinkIsWrittenWhereItPoints) {
  const TemporaryFolder folder;
  const auto model = write_text(folder / "model.toml", kSquare);
  std::filesystem::create_symlink("new.msh", folder / "link.msh");
  EXPECT_EQ(delquad({"mesh", model, "-o", folder / "link.msh", "--size", "0.5"}).exit_code, 0);
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link.msh"));
  EXPECT_TRUE(std::filesystem::is_regular_file(folder / "new.msh"));
}

/// Through the shell, which sets up the standard output.
TEST(Output, LostStandardOutputIsNoSuccess) {
  NEEDS_FILE("/dev/full");
  const TemporaryFolder folder;
  const auto model = write_text(folder / "model.toml", kSquare);
  for (const char* redirection : {"> /dev/full", ">&-"}) {
    const std::string command = std::string(DELQUAD_PROGRAM) + " mesh " + model.string() + " --size 0.5 -o " +
                                (folder / "out.msh").string() + " " + redirection;
    const ProgramResult result = run_program("/bin/sh", {{"-c", command}, 0, {}});
    EXPECT_EQ(result.exit_code, 2) << redirection;
    EXPECT_TRUE(contains(result.err, "standard output")) << result.err;
  }
}

/// What one may not write, or not all of, and a device that is full.
TEST(Output, FullDiskLeavesNothing) {
  NEEDS_FILE("/dev/full");
  const TemporaryFolder folder;
  const auto model = write_text(folder / "model.toml", kSquare);
  for (const MeshFormat& format : mesh_formats()) {
    if (!can_write(format) || !format.package.empty()) continue;
    const std::string name = "out" + format.extensions[0], link = "link" + format.extensions[0];
    expect_refusal(run_program(DELQUAD_PROGRAM,
                               {{"mesh", "-q", model, "-o", folder / name, "--size", "0.04"}, 4096, {}}),
                   {folder.path().c_str(), "File too large"});
    EXPECT_EQ(folder.names(), std::vector<std::string>{"model.toml"});
    std::filesystem::create_symlink("/dev/full", folder / link);
    if (format.extensions[0] == ".xdmf") std::filesystem::create_symlink("/dev/full", folder / "link.h5");
    expect_refusal(delquad({"mesh", "-q", model, "-o", folder / link, "--size", "0.04"}),
                   {"link.", "No space left"});
    std::filesystem::remove(folder / link);
    std::filesystem::remove(folder / "link.h5");
    EXPECT_EQ(folder.names(), std::vector<std::string>{"model.toml"});
  }
}

TEST(Output, FolderThatIsAFileIsRefusedBeforeWork) {
  const TemporaryFolder folder;
  const auto file = write_text(folder / "e.toml", "[[case]]\nname = \"a\"\nsize = 0.1\n" + kSquare);
  expect_refusal(delquad({"run", file, "-o", file / "results"}), {"results"});
}

}  // namespace
}  // namespace delquad::testing_support
