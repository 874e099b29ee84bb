// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/sweep/run_experiment.h"
#include "metrics/tables/result_records.h"
#include "tests/support/files.h"

namespace delquad {
namespace {

const std::string kSquareWith = "[[case]]\nname = 'a'\nsize = 0.5\n";
const std::string kLoop = "loop = { rectangle = [[0, 0], [1, 1]], boundary = 'wall' }\n";

class StaleKeys : public testing::Test {
 protected:
  Json run(const std::string& text) {
    const Outcome outcome =
        run_experiment(Experiment::read(write_text(folder_ / "e.toml", text), folder_ / "data"), out());
    EXPECT_EQ(outcome.bad_inputs + outcome.others_failed, 0) << text;
    return record();
  }
  Json record() const { return Json::parse(read_text(out() / "a/DB/record.json")); }
  fs::path out() const { return folder_ / "out"; }
  /// Runs both into one folder: the second makes a new cell, and the first one again makes the cell that was
  /// there.
  void expect_new_cell(const std::string& without, const std::string& with) {
    const std::string head = "pipelines = ['DB']\n";
    const Json first = run(head + without), second = run(head + with);
    EXPECT_NE(first["key"], second["key"]) << with;
    EXPECT_NE(first["problem"], second["problem"]) << with;
    const auto written = fs::last_write_time(out() / "a/DB/record.json");
    EXPECT_EQ(run(head + with)["key"], second["key"]);
    EXPECT_EQ(fs::last_write_time(out() / "a/DB/record.json"), written) << "is made again: " << with;
    EXPECT_EQ(run(head + without)["key"], first["key"]) << with;
  }
  Folder folder_;
};

TEST_F(StaleKeys, OrderOfACaseOrTheWholeFile) {
  expect_new_cell(kSquareWith + kLoop, kSquareWith + "order = 2\n" + kLoop);
  expect_new_cell(kSquareWith + kLoop, "order = 2\n" + kSquareWith + kLoop);
}

TEST_F(StaleKeys, OrderOfAModelFile) {
  const std::string experiment = kSquareWith + "model = 'm.toml'\n";
  write_text(folder_ / "m.toml", kLoop);
  const Json first = run("pipelines = ['DB']\n" + experiment);
  write_text(folder_ / "m.toml", "order = 3\n" + kLoop);
  EXPECT_NE(run("pipelines = [\"DB\"]\n" + experiment)["key"], first["key"]);
}

TEST_F(StaleKeys, RegionsOfLayers) {
  const std::string two = kSquareWith +
                          "loop = [{ rectangle = [[0, 0], [1, 1]], region = 'left', boundary = 'wall' }, { "
                          "rectangle = [[1, 0], [2, 1]], region = 'right' }]\n";
  const std::string layer = "[[case.layer]]\non = 'wall'\nfirst = 0.01\nnumber = 3\n";
  expect_new_cell(two + layer, two + layer + "into = 'left'\n");
}

TEST_F(StaleKeys, PointsAndCracks) {
  const std::string point = "[[case.embed]]\npoint = [0.3, 0.4]\n";
  expect_new_cell(kSquareWith + kLoop, kSquareWith + kLoop + point);
  expect_new_cell(kSquareWith + kLoop + point, kSquareWith + kLoop + "[[case.embed]]\npoint = [0.4, 0.4]\n");
  expect_new_cell(kSquareWith + kLoop + point, kSquareWith + kLoop + point + "name = 'load'\n");
  const std::string line = "[[case.embed]]\nsegment = [[0.3, 0.5], [0.7, 0.5]]\n";
  expect_new_cell(kSquareWith + kLoop + line, kSquareWith + kLoop + line + "crack = true\n");
}

TEST_F(StaleKeys, CurvesThatAgreeAtSamples) {
  const auto model = [](const std::string& y) {
    return "[[case]]\nname = \"a\"\nsize = 0.25\nloop = { curves = [\"low\", \"high\"] }\n"
           "[[case.curve]]\nname = \"low\"\nexpression = { x = \"t\", y = \"" +
           y +
           "\", from = 0, to = 1 }\n"
           "[[case.curve]]\nname = \"high\"\npolyline = [[1, 0], [1, 1], [0, 1], [0, 0]]\n";
  };
  expect_new_cell(model("0"), model("max(0, 0.02 - abs(t - 0.5))"));
}

/// Results count as the experiment says now: the domain is in the study and in no record.
TEST_F(StaleKeys, DomainThatResultsCountAs) {
  const std::string head = "pipelines = ['DB']\n" + kSquareWith;
  const Json first = run(head + kLoop);
  EXPECT_EQ(run(head + "domain = \"plates\"\n" + kLoop), first);
  EXPECT_TRUE(holds(read_text(out() / "study.json"), "plates"));
}

#if DELQUAD_HAS_CAD
TEST_F(StaleKeys, NamesOnSurfaces) {
  const std::string box = "[[case]]\nname = 'a'\nexample = 'pipe_tee'\nsize = 12\n";
  const auto named = [&](const std::string& fits) {
    return box + "[[case.surface.name]]\nas = 'load'\n" + fits;
  };
  expect_new_cell(box, named("number = [2]\n"));
  expect_new_cell(named("number = [2]\n"), named("number = [1]\n"));
  expect_new_cell(named("number = [2]\n"), named("of = 'curves'\nnumber = [2]\n"));
}
#endif

/// Words of reports make no new cell, and no record has them.
TEST_F(StaleKeys, NamesOfCriteriaAreInNoRecord) {
  const std::string head = "pipelines = ['DB']\n" + kSquareWith + kLoop + "[case.criteria]\nmin_angle = 10\n";
  const Json first = run(head + "name = 'ours'\n");
  EXPECT_EQ(run(head + "name = \"theirs\"\n"), first);
  EXPECT_FALSE(holds(first.dump(), "ours"));
}

TEST_F(StaleKeys, RecordsOfOtherVersionsAreRefused) {
  run("pipelines = ['DB']\n" + kSquareWith + kLoop);
  Json old = Json::parse(read_text(out() / "a/DB/record.json"));
  old.erase("record");
  old.erase("digest");
  write_text(out() / "a/DB/record.json", old.dump(2));
  const std::vector<CellRecord> records = read_records(out());
  ASSERT_EQ(records.size(), 1u);
  EXPECT_TRUE(holds(records[0].reason, "record of version 1: expected version 3"));
}

}  // namespace
}  // namespace delquad
