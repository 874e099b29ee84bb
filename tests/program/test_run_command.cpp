#include <gtest/gtest.h>

#include <algorithm>

#include "tests/program/program.h"

namespace delquad::testing_support {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> all_files(const fs::path& folder) {
  std::vector<std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) files.push_back(fs::relative(entry.path(), folder).string());
  std::sort(files.begin(), files.end());
  return files;
}

const std::string kExperiment =
    "title = \"A square\"\npipelines = [\"D\", \"DB\"]\nreference = \"published.toml\"\n"
    "[[case]]\nname = \"square\"\nsize = 0.1\ncompare = { DB = \"Theirs\" }\n" +
    kSquare;
const std::string kPublished = "source = \"Table 9\"\n[[row]]\nname = \"Theirs\"\neta_mean = 0.75\nd4 = 87\n";

/// An experiment on squares with these names and sizes.
fs::path write_squares(const TemporaryFolder& folder, const std::string& words,
                       const std::vector<std::pair<std::string, std::string>>& squares) {
  std::string text = "pipelines = [" + words + "]\n";
  for (const auto& [name, size] : squares)
    text += "[[case]]\nname = \"" + name + "\"\nsize = " + size + "\n" + kSquare;
  return write_text(folder / "e.toml", text);
}

TEST(RunCommand, WritesCellsTablesAndPictures) {
  const TemporaryFolder folder;
  write_text(folder / "published.toml", kPublished);
  const auto file = write_text(folder / "e.toml", kExperiment);
  const ProgramResult result = delquad({"run", file, "-o", folder / "results"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  // The experiment, the published rows and the list of both lie below a name that is a digest.
  std::vector<std::string> files = all_files(folder / "results");
  EXPECT_EQ(std::erase_if(files, [](const std::string& name) { return name.starts_with("experiment/"); }), 3);
  EXPECT_EQ(files,
            (std::vector<std::string>{".lock", "runs.csv", "runs_columns.csv", "square/D/fields.vtu",
                                      "square/D/mesh.msh", "square/D/mesh.vtu", "square/D/picture.svg",
                                      "square/D/record.json", "square/DB/fields.vtu", "square/DB/mesh.msh",
                                      "square/DB/mesh.vtu", "square/DB/picture.svg", "square/DB/record.json",
                                      "study.json", "table.csv", "table.json", "table.md", "table.tex"}));
  const std::string table = read_text(folder / "results" / "table.md");
  EXPECT_TRUE(contains(result.out, table));
  EXPECT_TRUE(contains(table, "1.000 (0.75, +0.250)")) << table;
  EXPECT_TRUE(contains(table, "100.0 (87, +13.0)")) << table;
  EXPECT_TRUE(contains(table, "Table 9")) << table;
}

TEST(RunCommand, PipelinesCanBeChosen) {
  const TemporaryFolder folder;
  write_text(folder / "published.toml", kPublished);
  const auto file = write_text(folder / "e.toml", kExperiment);
  ASSERT_EQ(delquad({"run", file, "-o", folder / "results", "--pipelines", "F,FB"}).exit_code, 0);
  EXPECT_TRUE(fs::exists(folder / "results/square/FB/record.json"));
  EXPECT_FALSE(fs::exists(folder / "results/square/DB"));
  for (const char* words : {"F,F", "D,,F", "", "D,"})
    EXPECT_EQ(delquad({"run", file, "-o", folder / "results", "--pipelines", words}).exit_code, 2) << words;
}

TEST(RunCommand, SameBytesTwice) {
  const TemporaryFolder folder;
  write_text(folder / "published.toml", kPublished);
  const auto file = write_text(folder / "e.toml", kExperiment);
  for (const char* results : {"a", "b"})
    ASSERT_EQ(delquad({"run", file, "-o", folder / results}).exit_code, 0);
  for (const std::string& name : all_files(folder / "a")) {
    if (!name.ends_with(".msh") && !name.ends_with(".vtu") && !name.ends_with(".svg")) continue;
    EXPECT_EQ(read_text(folder / "a" / name), read_text(folder / "b" / name)) << name;
  }
}

TEST(RunCommand, FailedCellIsInTheTableAndTheRestGoesOn) {
  const TemporaryFolder folder;
  const auto file = write_squares(folder, "\"DB\"", {{"bad", "\"x - 0.5\""}, {"good", "0.1"}});
  const fs::path stale = folder / "results/bad/DB";
  fs::create_directories(stale);
  write_text(stale / "mesh.msh", "from an earlier run");
  const ProgramResult result = delquad({"run", file, "-o", folder / "results"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_TRUE(contains(result.err, "error: bad DB: ")) << result.err;
  const std::string table = read_text(folder / "results/table.md");
  EXPECT_TRUE(contains(table, "failed")) << table;
  EXPECT_TRUE(contains(table, "x - 0.5")) << table;
  EXPECT_TRUE(contains(read_text(folder / "results/bad/DB/record.json"), "\"status\": \"failed\""));
  EXPECT_FALSE(fs::exists(stale / "mesh.msh"));
  EXPECT_TRUE(fs::exists(folder / "results/good/DB/mesh.msh"));
}

/// The larger meshes do not fit: their cells fail, with their reasons, and nothing of them is left.
TEST(RunCommand, CellThatCannotBeWrittenFailsAlone) {
  const TemporaryFolder folder;
  const auto file = write_squares(folder, "\"F\", \"DB\"", {{"large", "0.02"}, {"small", "0.25"}});
  const ProgramResult result =
      run_program(DELQUAD_PROGRAM, {{"run", file, "-o", folder / "results"}, 100'000, {}});
  EXPECT_EQ(result.exit_code, 2) << result.err;
  const std::string table = read_text(folder / "results/table.md");
  EXPECT_TRUE(contains(table, "large F failed: ")) << table;
  EXPECT_TRUE(contains(table, "large/F/mesh.msh: cannot be written")) << table;
  EXPECT_EQ(all_files(folder / "results/large/F"), std::vector<std::string>{"record.json"});
  EXPECT_EQ(all_files(folder / "results/small/DB").size(), 5u);
  for (const std::string& name : all_files(folder / "results")) EXPECT_FALSE(contains(name, ".tmp")) << name;
}

TEST(RunCommand, FilesOfOthersInACellStay) {
  const TemporaryFolder folder;
  const auto file =
      write_text(folder / "e.toml", "pipelines = [\"D\"]\n[[case]]\nname = \"a\"\nsize = 0.5\n" + kSquare);
  fs::create_directories(folder / "results/a/D");
  write_text(folder / "results/a/D/notes.txt", "mine");
  for (int k = 0; k < 2; ++k) ASSERT_EQ(delquad({"run", file, "-o", folder / "results"}).exit_code, 0);
  EXPECT_EQ(all_files(folder / "results/a/D"),
            (std::vector<std::string>{"fields.vtu", "mesh.msh", "mesh.vtu", "notes.txt", "picture.svg",
                                      "record.json"}));
}

TEST(RunCommand, MistakesOfTheFileAreFoundBeforeAnyWork) {
  const TemporaryFolder folder;
  write_text(folder / "published.toml", kPublished);
  const auto refused = [&](const std::string& text, const std::string& part) {
    const auto file = write_text(folder / "e.toml", text);
    const ProgramResult result = delquad({"run", file, "-o", folder / "results"});
    EXPECT_EQ(result.exit_code, 2) << text;
    EXPECT_TRUE(contains(result.err, part)) << result.err;
    EXPECT_FALSE(fs::exists(folder / "results"));
  };
  refused(kExperiment + "[[case]]\nname = \"square\"\n" + kSquare, "second case 'square'");
  refused(kExperiment + "[[case]]\nname = \"Square\"\n" + kSquare, "share its folder");
  refused("[[case]]\nname = \"Table.md\"\nsize = 1\n" + kSquare, "file of results");
  refused("[[case]]\nname = \"../escape\"\nsize = 1\n" + kSquare, "names a folder");
  refused("pipeline = [\"D\"]\n[[case]]\nname = \"a\"\nsize = 1\n" + kSquare, "'pipelines'");
  refused("pipelines = [\"DQ\"]\n[[case]]\nname = \"a\"\nsize = 1\n" + kSquare, "'Q'");
  refused("[[case]]\nname = \"a\"\nsize = 1\n", "no model");
  refused("[[case]]\nname = \"a\"\nsize = 1\ninsertion = { hmax = 1 }\n" + kSquare, "'h_max'");
  refused("[[case]]\nname = \"a\"\nsize = 1\nrecombination = { treatment = \"best\" }\n" + kSquare,
          "\"none\" or \"paper\"");
  refused(
      "reference = \"published.toml\"\ncompare = { DB = \"Thiers\" }\n[[case]]\nname = \"a\"\nsize = 1\n" +
          kSquare,
      "'Theirs'");
  refused("[[case]]\nname = \"good\"\nsize = 1\n" + kSquare + "[[case]]\nname = \"a\"\nsize = \"0.1 + u\"\n" +
              kSquare,
          "e.toml:7: expression '0.1 + u', position 7: 'u' is not known");
  refused("[[case]]\nname = \"a\"\nsize = 1\ncross = \"bonudary\"\n" + kSquare, "did you mean 'boundary'?");
  refused("[matrix]\nsize = [0.1, \"x +\"]\n[[case]]\nname = \"a\"\n" + kSquare,
          "e.toml:2: expression 'x +', position");
  refused(
      "[[case]]\nname = \"good\"\nsize = 1\n" + kSquare + "[[case]]\nname = \"a\"\nmodel = \"gone.step\"\n",
      "e.toml:5: case 'a': there is no file '");
  refused("reference = \"none.toml\"\n[[case]]\nname = \"a\"\nsize = 1\n" + kSquare, "none.toml");
}

TEST(RunCommand, InterruptKeepsFinishedCellsWhole) {
  const TemporaryFolder folder;
  std::string text = "pipelines = [\"FB\", \"DB\"]\n";
  for (const char* name : {"a", "b", "c", "d"})
    text += std::string("[[case]]\nname = \"") + name + "\"\nsize = 0.008\n" + kSquare;
  const auto file = write_text(folder / "e.toml", text);
  const fs::path first = folder / "results/a/FB/record.json";
  const ProgramResult result = run_program(
      DELQUAD_PROGRAM, {{"run", file, "-o", folder / "results"}, 0, [&] { return fs::exists(first); }});
  EXPECT_EQ(result.exit_code, 130);
  EXPECT_TRUE(fs::exists(first));
  EXPECT_FALSE(fs::exists(folder / "results/d/DB/record.json"));
  const std::vector<std::string> whole = {"fields.vtu", "mesh.msh", "mesh.vtu", "picture.svg", "record.json"};
  std::size_t cells = 0;
  for (const std::string& name : all_files(folder / "results")) {
    const fs::path path = folder / "results" / name;
    EXPECT_TRUE(std::count(whole.begin(), whole.end(), path.filename()) || path.extension() == ".svg" ||
                name == ".lock" || name == "study.json" || name.starts_with("experiment/"))
        << name;
    if (path.filename() != "record.json") continue;
    ++cells;
    for (const std::string& part : whole) EXPECT_TRUE(fs::exists(path.parent_path() / part)) << path;
    EXPECT_TRUE(read_text(path.parent_path() / "mesh.msh").ends_with("$EndElements\n"));
  }
  EXPECT_GE(cells, 1u);
}

}  // namespace
}  // namespace delquad::testing_support
