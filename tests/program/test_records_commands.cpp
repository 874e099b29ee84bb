#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/program/program.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/triangulated_shapes.h"

namespace delquad {
namespace {

namespace fs = std::filesystem;
using namespace testing_support;

const std::string kExperiment =
    "pipelines = [\"D\", \"DB\"]\n[[case]]\nname = \"square\"\nsize = 0.25\n" + kSquare;

class RecordsCommands : public testing::Test {
 protected:
  void SetUp() override {
    file_ = write_text(folder_ / "e.toml", kExperiment);
    ASSERT_EQ(delquad({"run", file_, "-o", out()}).exit_code, 0);
  }
  std::string out() const { return (folder_ / "out").string(); }
  TemporaryFolder folder_;
  std::string file_;
};

TEST_F(RecordsCommands, VerifySaysWhatIsWrong) {
  const ProgramResult well = delquad({"verify", out()});
  EXPECT_EQ(well.exit_code, 0) << well.out;
  EXPECT_EQ(well.out, out() + ": 2 records, 2 meshes measured again: all well\n");
  fs::resize_file(out() + "/square/DB/mesh.msh", 100);
  const ProgramResult cut = delquad({"verify", out(), "-j", "1"});
  EXPECT_EQ(cut.exit_code, 1);
  EXPECT_TRUE(contains(cut.out, out() + "/square/DB/mesh.msh: holds 100 bytes, expected ")) << cut.out;
  EXPECT_TRUE(contains(cut.out, "1 findings")) << cut.out;
  const ProgramResult nowhere = delquad({"verify", folder_ / "nowhere"});
  EXPECT_EQ(nowhere.exit_code, 2);
  EXPECT_TRUE(contains(nowhere.err, "nowhere")) << nowhere.err;
}

TEST_F(RecordsCommands, RerunOfAMovedFolder) {
  fs::create_directories(folder_ / "far/away");
  fs::rename(out(), folder_ / "far/away/results");
  fs::remove(file_);
  const fs::path record = folder_ / "far/away/results/square/DB/record.json";
  const ProgramResult again = delquad({"rerun", record});
  EXPECT_EQ(again.exit_code, 0) << again.out << again.err;
  EXPECT_TRUE(contains(again.out, "the same mesh, byte for byte\n")) << again.out;
  std::string text = read_text(record);
  const auto at = text.find("\"eta_mean\": ") + 12;
  text.replace(at, text.find(',', at) - at, "0.5");
  write_text(record, text);
  const ProgramResult edited = delquad({"rerun", record});
  EXPECT_EQ(edited.exit_code, 1);
  EXPECT_TRUE(contains(edited.out, "differs: value metrics eta_mean: 0.5 in the record, ")) << edited.out;
}

/// Curves of all kinds, a triangulation in STL, and CAD; and a record of 'mesh' itself.
TEST_F(RecordsCommands, MeshOfARecordIsTheSame) {
  const Mesh lens = testing_support::lens(64, 12, 0.45);
  std::string stl = "solid lens\n";
  for (const auto& triangle : lens.triangles) {
    stl += "facet normal 0 0 0\nouter loop\n";
    for (const int v : triangle)
      stl += fmt::format("vertex {} {} {}\n", lens.points[v].x, lens.points[v].y, lens.points[v].z);
    stl += "endloop\nendfacet\n";
  }
  write_text(folder_ / "lens.stl", stl + "endsolid lens\n");
  std::string text =
      "pipelines = [\"DBCO\"]\n"
      "[[case]]\nname = \"curves\"\norder = 2\nsize = { base = \"0.1 + 0.1*x\", gradation = 0.3 }\n"
      "loop = { curves = [\"a\", \"b\", \"c\"] }\nembed = [{ point = [1, 0.5], name = \"p\" }]\n"
      "curve = [{ name = \"a\", spline = [[0, 0], [0.7, -0.2], [2, 0]] }, { name = \"b\", polyline = [[2, "
      "0], [2, 1], [0, 1]] }, { name = \"c\", expression = { x = \"0.1*sin(pi*t)\", y = \"1 - t\", from = 0, "
      "to = 1 } }]\n"
      "[[case]]\nname = \"lens\"\nmodel = \"lens.stl\"\nsize = 0.3\nsurface = { feature_angle = 30 }\n";
#if DELQUAD_HAS_CAD
  ASSERT_EQ(delquad({"example", "pipe_tee", "-o", folder_ / "tee.step"}).exit_code, 0);
  text += "[[case]]\nname = \"tee\"\nmodel = \"tee.step\"\nsize = 12\norder = 2\n";
#endif
  ASSERT_EQ(delquad({"run", write_text(folder_ / "all.toml", text), "-o", folder_ / "all"}).exit_code, 0);
  for (const auto& entry : fs::recursive_directory_iterator(folder_ / "all")) {
    if (entry.path().filename() != "record.json") continue;
    const ProgramResult again = delquad({"mesh", entry.path(), "-o", folder_ / "again.msh"});
    ASSERT_EQ(again.exit_code, 0) << again.err;
    EXPECT_EQ(read_text(folder_ / "again.msh"), read_text(entry.path().parent_path() / "mesh.msh"))
        << entry.path();
  }
  const auto mesh = [&](const std::string& model, const char* to) {
    return delquad({"mesh", folder_ / model, "-o", folder_ / to, "--json", folder_ / "own.json"});
  };
  write_text(folder_ / "square.toml", kSquare + "size = 0.2\n");
  ASSERT_EQ(mesh("square.toml", "one.msh").exit_code, 0);
  ASSERT_EQ(mesh("own.json", "two.msh").exit_code, 2) << "would be overwritten";
  fs::copy(folder_ / "own.json", folder_ / "first.json");
  ASSERT_EQ(mesh("first.json", "two.msh").exit_code, 0);
  EXPECT_EQ(read_text(folder_ / "two.msh"), read_text(folder_ / "one.msh"));
  const ProgramResult rerun = delquad({"rerun", folder_ / "first.json"});
  EXPECT_EQ(rerun.exit_code, 2);
  EXPECT_TRUE(contains(rerun.err, "'delquad mesh " + (folder_ / "first.json").string() + " -o FILE'"))
      << rerun.err;
  ASSERT_EQ(delquad({"mesh", folder_ / "lens.stl", "--size", "0.3", "-o", folder_ / "lens.msh", "--json",
                     folder_ / "lens.json"})
                .exit_code,
            0);
  fs::create_directory(folder_ / "moved");
  for (const char* file : {"lens.stl", "lens.json"}) fs::rename(folder_ / file, folder_ / "moved" / file);
  ASSERT_EQ(mesh("moved/lens.json", "moved.msh").exit_code, 0);
  EXPECT_EQ(read_text(folder_ / "moved.msh"), read_text(folder_ / "lens.msh"));
  fs::remove(folder_ / "moved/lens.stl");
  const ProgramResult lost = mesh("moved/lens.json", "lost.msh");
  EXPECT_TRUE(contains(lost.err, "neither here nor, by its name, beside the record: expected")) << lost.err;
  write_text(folder_ / "part.json", "{\"record\": 3, \"case\": \"a\"}");
  const ProgramResult part = mesh("part.json", "part.msh");
  EXPECT_EQ(part.exit_code, 2);
  EXPECT_TRUE(contains(part.err, "part.json: is no record of a mesh")) << part.err;
  std::string old = read_text(folder_ / "first.json");
  write_text(folder_ / "first.json", old.replace(old.find("\"record\": 3"), 11, "\"record\": 2"));
  const ProgramResult refused = mesh("first.json", "two.msh");
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_TRUE(contains(refused.err, "record of version 2: expected version 3")) << refused.err;
}

TEST_F(RecordsCommands, MergeOfShards) {
  for (const char* shard : {"0", "1"})
    ASSERT_EQ(delquad({"run", file_, "-o", folder_ / (std::string("part") + shard), "--shard",
                       std::string(shard) + "/2"})
                  .exit_code,
              0);
  const std::string all = (folder_ / "all").string();
  const ProgramResult merged = delquad({"merge", folder_ / "part0", folder_ / "part1", "-o", all});
  EXPECT_EQ(merged.exit_code, 0) << merged.err;
  EXPECT_EQ(delquad({"verify", all}).exit_code, 0);
  EXPECT_EQ(read_text(all + "/square/DB/mesh.msh"), read_text(out() + "/square/DB/mesh.msh"));
  EXPECT_EQ(delquad({"merge", folder_ / "part0", folder_ / "part1", "-o", all}).exit_code, 2);
  EXPECT_EQ(delquad({"merge", folder_ / "part0", "-o", folder_ / "one"}).exit_code, 2);
}

TEST_F(RecordsCommands, PicturesAreSvgOrNone) {
  const std::string none = (folder_ / "none").string();
  EXPECT_EQ(delquad({"run", file_, "-o", none, "--pictures", "none"}).exit_code, 0);
  EXPECT_FALSE(fs::exists(none + "/square/DB/picture.svg"));
  EXPECT_FALSE(fs::exists(none + "/square/DB/fields.vtu"));
  EXPECT_TRUE(fs::exists(none + "/square/DB/mesh.vtu"));
  EXPECT_TRUE(fs::exists(out() + "/square/DB/picture.svg"));
  EXPECT_EQ(delquad({"run", file_, "-o", none, "--pictures", "jpg"}).exit_code, 2);
}

}  // namespace
}  // namespace delquad
