#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <sstream>
#include <string>

#include "io/mesh_io.h"
#include "tests/program/program.h"

namespace delquad::testing_support {
namespace {

/// With a corner of 25 degrees.
const std::string kWedge = "[[loop]]\npolygon = [[0, 0], [6, 0], [6, 2.8]]\nregion = \"plate\"\n";

/// The numbers of an element set.
std::set<int> set_of(const std::string& inp, const std::string& name) {
  const std::string head = "*ELSET, ELSET=" + name + "\n";
  std::set<int> numbers;
  const auto from = inp.find(head);
  if (from == std::string::npos) return numbers;
  std::string text = inp.substr(from + head.size(), inp.find('*', from + head.size()) - from - head.size());
  std::ranges::replace(text, ',', ' ');
  std::istringstream in(text);
  for (int n = 0; in >> n;) numbers.insert(n);
  return numbers;
}

TEST(Criteria, GiveATableAndSets) {
  const TemporaryFolder folder;
  const auto model = write_text(folder / "m.toml", kWedge);
  const ProgramResult plain = delquad({"mesh", model, "-o", folder / "plain.msh", "--size", "0.4"});
  const ProgramResult judged =
      delquad({"mesh", model, "-o", folder / "judged.msh", "--size", "0.4", "--criteria", "batch"});
  ASSERT_EQ(judged.exit_code, 0) << judged.err;
  EXPECT_EQ(read_text(folder / "plain.msh"), read_text(folder / "judged.msh"));
  EXPECT_FALSE(contains(plain.out, "criteria"));
  for (const char* part : {"criteria batch: ", " elements fail", "min_angle", "40 degrees", "(corner)",
                           "time step: critical", "radioss", "in sharp corners of the model"})
    EXPECT_TRUE(contains(judged.out, part)) << part << " in " << judged.out;

  ASSERT_EQ(delquad({"mesh", model, "-o", folder / "sets.inp", "--size", "0.4", "--criteria", "batch",
                     "--failing-sets", "--json", folder / "r.json"})
                .exit_code,
            0);
  const std::string inp = read_text(folder / "sets.inp"), record = read_text(folder / "r.json");
  for (const char* set :
       {"*ELSET, ELSET=failing\n", "*ELSET, ELSET=failing_min_angle\n", "*ELSET, ELSET=plate\n"})
    EXPECT_TRUE(contains(inp, set)) << set;
  ASSERT_EQ(delquad({"mesh", model, "-o", folder / "plain.inp", "--size", "0.4"}).exit_code, 0);
  EXPECT_EQ(set_of(inp, "region_1"), set_of(read_text(folder / "plain.inp"), "region_1"));
  EXPECT_GT(set_of(inp, "region_1").size(), set_of(inp, "failing").size());
  const ProgramResult other = delquad(
      {"mesh", model, "-o", folder / "sets.msh", "--size", "0.4", "--criteria", "batch", "--failing-sets"});
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_TRUE(contains(other.err, "expected an .inp file")) << other.err;
  for (const char* key : {"\"failing_min_angle\"", "\"critical_step\"", "\"cause\": \"corner\""})
    EXPECT_TRUE(contains(record, key)) << key;
}

TEST(Criteria, AreAnErrorWhenStrict) {
  const TemporaryFolder folder;
  const auto model = write_text(folder / "m.toml", kWedge);
  const ProgramResult refused =
      delquad({"mesh", model, "-o", folder / "m.msh", "--size", "0.4", "--criteria", "batch", "--strict"});
  EXPECT_EQ(refused.exit_code, 5);
  EXPECT_TRUE(contains(refused.out, "criteria batch: ")) << refused.out;
  EXPECT_TRUE(contains(refused.err, "an angle below 40 degrees")) << refused.err;
  EXPECT_FALSE(std::filesystem::exists(folder / "m.msh"));
  const ProgramResult none =
      delquad({"mesh", model, "-o", folder / "m.msh", "--size", "0.4", "--criteria", ""});
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_TRUE(contains(none.err, "--criteria: unknown criteria ''")) << none.err;
  const ProgramResult alone = delquad({"mesh", model, "-o", folder / "m.msh", "--size", "0.4", "--strict"});
  EXPECT_EQ(alone.exit_code, 2);
  EXPECT_TRUE(contains(alone.err, "expected --criteria")) << alone.err;
}

TEST(Criteria, JudgeMeshesOfOthers) {
  const TemporaryFolder folder;
  const auto model = write_text(folder / "m.toml", kWedge);
  ASSERT_EQ(delquad({"mesh", model, "-o", folder / "m.obj", "--size", "0.4"}).exit_code, 0);
  const ProgramResult result = delquad({"metrics", folder / "m.obj", "--size", "0.4", "--criteria", "batch"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(contains(result.out, "0.33 size")) << result.out;
  EXPECT_EQ(delquad({"metrics", folder / "m.obj", "--criteria", "batch", "--strict"}).exit_code, 5);
}

TEST(Criteria, AreColumnsOfExperiments) {
  const TemporaryFolder folder;
  write_text(folder / "m.toml", kWedge);
  const auto experiment = write_text(folder / "e.toml",
                                     "pipelines = [\"DB\"]\ncriteria = \"batch\"\nsize = 0.4\ncolumns = "
                                     "[\"failing\", \"failing_min_angle\", \"time_step\"]\n"
                                     "[[case]]\nname = \"wedge\"\nmodel = \"m.toml\"\n");
  const ProgramResult run = delquad({"run", experiment, "-o", folder / "results"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const ProgramResult table = delquad({"tables", folder / "results"});
  EXPECT_TRUE(contains(run.out + table.out, "failing min_angle")) << run.out << table.out;
}

TEST(Criteria, JudgeWhatIsImprovedBeforeAndAfter) {
  const TemporaryFolder folder;
  const auto model = write_text(folder / "m.toml", kWedge);
  ASSERT_EQ(delquad({"mesh", model, "-o", folder / "m.msh", "--size", "0.4", "--quality", "fast"}).exit_code,
            0);
  const ProgramResult r =
      delquad({"improve", folder / "m.msh", "-o", folder / "n.msh", "--criteria", "batch"});
  ASSERT_EQ(r.exit_code, 0) << r.err;
  const auto before = r.out.find("criteria batch: ");
  EXPECT_NE(r.out.find("criteria batch: ", before + 1), std::string::npos) << r.out;
}

TEST(Washers, AreToldOnTheCommandLine) {
  const TemporaryFolder folder;
  const auto model =
      write_text(folder / "m.toml",
                 "size = 1.7\nloop = [{ rectangle = [[0, 0], [20, 20]] }, { circle = { centre = [10, "
                 "10], radius = 3 } }]\n");
  const auto run = [&](const std::string& washers) {
    return delquad({"mesh", model, "-o", folder / "m.msh", "--washers", washers});
  };
  const ProgramResult good = run("5-7:2:16:3");
  EXPECT_EQ(good.exit_code, 0) << good.err;
  EXPECT_TRUE(contains(good.out, "32 quads on 16 edges")) << good.out;
  for (const auto& [text, part] :
       {std::pair("5-7:2:16:3:1", "expected LEAST-MOST[:ROWS[:EDGES[:WIDTH]]]"),
        {"5-7:2:15", "15 edges around holes: expected an even number"},
        {"5-7:0", "'rows' is 0: expected 1 to 1000"},
        {"5-7:-1", "'rows' is -1: expected 1 to 1000"},
        {"5-7:1.5", "--washers: 'washers.rows' must be an integer"},
        {"5", "--washers: 'washers.diameter' must be two numbers [least, most]"},
        {"5-x:2", "--washers: 'washers.diameter' must be two numbers [least, most]"},
        {"7-5:2", "diameters from 7 to 5"}}) {
    const ProgramResult bad = run(text);
    EXPECT_EQ(bad.exit_code, 2) << text;
    EXPECT_TRUE(contains(bad.err, part)) << text << ": " << bad.err;
  }
}

}  // namespace
}  // namespace delquad::testing_support
