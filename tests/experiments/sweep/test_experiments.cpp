// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/sweep/experiment.h"
#include "experiments/sweep/run_experiment.h"
#include "io/cases/case_file.h"
#include "metrics/metrics.h"
#include "metrics/tables/result_records.h"
#include "tests/support/files.h"
#include "tests/support/triangulated_shapes.h"

namespace delquad {
namespace {

TEST(Experiments, EveryFileOfTheProjectReads) {
  for (const auto& [folder, fewest] :
       {std::pair("paper", 7), {"studies", 12}, {"studies/on_suite", 3}, {"peers", 3}}) {
    int files = 0;
    for (const auto& entry : fs::directory_iterator(fs::path(DELQUAD_EXPERIMENTS) / folder)) {
      if (entry.path().extension() != ".toml") continue;
      ++files;
      EXPECT_NO_THROW(Experiment::read(entry.path())) << entry.path();
    }
    EXPECT_GE(files, fewest) << folder;
  }
}

TEST(Experiments, CasesMayBeThoseOfAnother) {
  const Folder folder;
  const auto square = [](const std::string& name) {
    return "[[case]]\nname = \"" + name + "\"\nloop = { rectangle = [[0, 0], [1, 1]] }\n";
  };
  write_text(folder / "other.toml", "size = 0.1\n" + square("a"));
  write_text(folder / "none.toml", "title = 'none'\n");
  const auto read = [&](const std::string& cases_of) {
    return Experiment::read(
        write_text(folder / "e.toml", "size = 0.5\ncases_of = \"" + cases_of + "\"\n" + square("b")));
  };
  const Experiment e = read("other.toml");
  ASSERT_EQ(e.n_cases(), 2u);
  EXPECT_EQ(e.read_variant(0).name + e.read_variant(1).name, "ab");
  EXPECT_EQ(e.read_variant(0).size.text, e.read_variant(1).size.text) << "other keys are its own";
  EXPECT_EQ(e.files().size(), 2u);
  expect_input_error([&] { read("none.toml"); }, {"e.toml:2: ", "none.toml has no cases"});
}

TEST(Experiments, LewisHasThePublishedRows) {
  const Experiment e = Experiment::read(fs::path(DELQUAD_EXPERIMENTS) / "paper/table1_lewis.toml");
  ASSERT_EQ(e.published.size(), 3u);
  const auto& delquad = e.published[2].values;
  EXPECT_EQ(e.published[2].name, "Delquad");
  EXPECT_EQ(delquad.at("eta_worst"), 0.25);
  EXPECT_EQ(delquad.at("tau"), 88);
  EXPECT_FALSE(e.published[1].values.contains("d4"));
  ASSERT_EQ(e.n_cases(), 2u);
  EXPECT_EQ(e.read_variant(0).compare.at("DB"), "Delquad");
}

/// The targets of the rotated square, end to end.
TEST(Experiments, RotatedSquareIsExact) {
  Experiment e = Experiment::read(fs::path(DELQUAD_EXPERIMENTS) / "studies/rotated_square.toml");
  e.parsed = {parse_pipeline("DB")};
  const Folder folder;
  const Outcome outcome = run_experiment(e, folder / "out");
  ASSERT_EQ(outcome.table.rows.size(), 3u);
  for (const TableRow& row : outcome.table.rows) {
    EXPECT_EQ(row.values.at("n_quads"), 400) << row.group;
    EXPECT_EQ(row.values.at("percent_quads"), 100) << row.group;
    EXPECT_NEAR(row.values.at("eta_worst"), 1, 1e-9) << row.group;
    EXPECT_EQ(row.values.at("d4"), 100) << row.group;
  }
}

TEST(Experiments, LewisReachesThePublishedRow) {
  Experiment e = Experiment::read(fs::path(DELQUAD_EXPERIMENTS) / "paper/table1_lewis.toml");
  e.parsed = {parse_pipeline("DB")};
  const Folder folder;
  const Outcome outcome = run_experiment(e, folder / "out");
  for (const TableRow& row : outcome.table.rows) {
    if (row.published.empty()) continue;
    for (const char* metric : {"eta_worst", "eta_mean", "d4", "d_min", "tau", "percent_quads"})
      EXPECT_GE(row.values.at(metric), row.published.at(metric)) << row.group << " " << metric;
    EXPECT_LE(row.values.at("d_max"), row.published.at("d_max")) << row.group;
  }
}

/// Keys at the top hold for planar cases and cases in space alike.
TEST(Experiments, TakeMetricsInSpace) {
  const Folder folder;
  write_mesh(folder / "can.obj", testing_support::can(24, 3));
  const auto file = write_text(folder / "e.toml",
                               "pipelines = ['DB']\n[[case]]\nname = 'can'\nmodel = 'can.obj'\nmetric = { "
                               "chord = 0.02, max = 0.5 }\n");
  const Outcome outcome = run_experiment(Experiment::read(file), folder / "out");
  EXPECT_EQ(outcome.bad_inputs + outcome.others_failed, 0);
  EXPECT_GT(read_records(folder / "out").at(0).values.at("metric_eta_mean"), 0.5);
}

TEST(Experiments, DataMayBeAbsent) {
  const Folder folder;
  const auto experiment = [&](const std::string& keys) {
    return Experiment::read(write_text(folder / "e.toml", "[[case]]\nname = 'a'\nsize = 1\n" + keys),
                            "there");
  };
  const Experiment e = experiment("data = 'cad/part.step'\n");
  EXPECT_EQ(model_path(e.read_variant(0)), fs::path("there") / "cad/part.step");
  EXPECT_TRUE(e.read_variant(0).may_be_absent);
  write_text(folder / "part.step", "");
  EXPECT_FALSE(experiment("model = \"part.step\"\n").read_variant(0).may_be_absent);
}

}  // namespace
}  // namespace delquad
