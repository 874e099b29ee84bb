// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/sweep/run_experiment.h"
#include "tests/support/files.h"
#include "tests/support/shared_data.h"

namespace delquad {
namespace {

using testing_support::shared_data;

Table run(const char* file, const Strings& words) {
  Experiment e = Experiment::read(fs::path(DELQUAD_EXPERIMENTS) / "paper" / file, shared_data());
  e.parsed = e.find_pipelines(words);
  const Folder folder;
  return run_experiment(e, folder / "out").table;
}

std::map<std::string, double> values(const Table& table, const std::string& word) {
  for (const TableRow& row : table.rows)
    if (row.name == word && row.group != "published") return row.values;
  return {};
}

/// Ours are at least as good as the published ones of the same row, d4 and tau by as much as a rounded
/// percentage hides.
void expect_published(const Table& table, const std::string& word) {
  constexpr double kRounded = 0.5;
  for (const TableRow& row : table.rows) {
    if (row.name != word || row.published.empty()) continue;
    for (const auto& [key, published] : row.published) {
      const bool exact = key == "eta_mean" || key == "eta_worst" || key == "percent_quads";
      if (!exact && key != "d4" && key != "tau") continue;
      EXPECT_GE(row.values.at(key), published - (exact ? 0 : kRounded)) << word << " " << key;
    }
  }
}

TEST(SurfaceExperiments, HoodReachesThePublishedRows) {
  if (!fs::exists(shared_data() / "cad/capot.brep")) GTEST_SKIP() << "data not found: " << shared_data();
  const Table table = run("fig17_hood.toml", {"F", "D", "FB", "DB"});
  constexpr double kPublishedTriangles = 3066, kMostRatio = 0.88, kMostValence = 6;
  const double d = values(table, "D").at("n_triangles"), f = values(table, "F").at("n_triangles");
  EXPECT_NEAR(d / kPublishedTriangles, 1, 0.01);
  EXPECT_LE(d / f, kMostRatio);
  for (const char* word : {"FB", "DB"}) {
    expect_published(table, word);
    EXPECT_LE(values(table, word).at("d_max"), kMostValence);
    EXPECT_EQ(values(table, word).at("percent_quads"), 100);
  }
  EXPECT_EQ(std::ranges::count(table.notes, "hood: uniform delta = 31.952"), 1);
}

TEST(SurfaceExperiments, FalconReachesThePublishedRow) {
  if (!fs::exists(shared_data() / "falcon_half.msh")) GTEST_SKIP() << "data not found: " << shared_data();
  const Table table = run("sec82_falcon.toml", {"DB"});
  constexpr double kPublishedQuads = 53297;
  EXPECT_NEAR(values(table, "DB").at("n_quads") / kPublishedQuads, 1, 0.03);
  expect_published(table, "DB");
  const std::set<std::string> of_other_words = {"adaptation", "smoothing", "clean-up", "regularity",
                                                "optimisation"};
  for (const StepTime& time : step_times_of_tables())
    EXPECT_EQ(values(table, "DB").contains(time.key), !of_other_words.contains(time.step)) << time.key;
}

}  // namespace
}  // namespace delquad
