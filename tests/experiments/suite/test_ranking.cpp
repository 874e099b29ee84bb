#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "delquad/error.h"
#include "experiments/suite/submission.h"
#include "experiments/suite/suite_list.h"
#include "metrics/tables/study_file.h"
#include "tests/support/temporary_folder.h"

namespace delquad::testing_support {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

void write_cell(const fs::path& results, const std::string& name, const std::string& program,
                const Json& more) {
  Json record = {{"record", 2},         {"key", "k"},     {"case", name},
                 {"pipeline", program}, {"status", "ok"}, {"meshing_seconds", 1}};
  record.update(more);
  fs::create_directories(results / name / program);
  std::ofstream(results / name / program / "record.json") << record.dump(2);
}

Json metrics(double eta, double tau, double quads) {
  return {{"metrics",
           {{"eta_mean", eta}, {"eta_worst", eta / 2}, {"d4", 90}, {"tau", tau}, {"percent_quads", quads}}}};
}

void write_study_of(const fs::path& results, const std::string& program, const std::string& title) {
  fs::create_directories(results);
  StudyFile study;
  study.title = title;
  study.experiment = "suite";
  study.pipelines = {program};
  for (const SuiteModel& model : suite().models)
    for (std::size_t k = 0; k < model.sizes.size(); ++k) study.cases.push_back(case_name(model, k));
  study.cells = study.cases.size();
  write_study(results, study);
}

TEST(Ranking, KeepsWhatFailedApartFromWhatIsMissing) {
  const TemporaryFolder folder;
  write_study_of(folder / "a", "few", suite_title());
  write_cell(folder / "a", "gear_1", "few", metrics(1, 100, 100));
  write_cell(folder / "a", "gear_2", "few", metrics(1, 100, 50));
  Json triangles_only = metrics(1, 70, 0);  // which have no eta of quads
  triangles_only["metrics"]["eta_mean"] = triangles_only["metrics"]["eta_worst"] = nullptr;
  write_cell(folder / "a", "gear_3", "few", triangles_only);
  write_cell(folder / "a", "bracket_1", "few", {{"status", "failed"}, {"reason", "it crashed"}});
  Json unsound = metrics(1, 100, 100);
  unsound["unsound"] = {"2 quads are inverted"};
  write_cell(folder / "a", "bracket_2", "few", unsound);
  write_study_of(folder / "b", "more", suite_title());
  for (const SuiteModel& model : suite().models)
    for (int k = 0; k < 3; ++k)
      if (is_for_all(model.family))
        write_cell(folder / "b", case_name(model, k), "more", metrics(0.5, 80, 100));

  const Table table = rank_programs(folder.path());
  ASSERT_EQ(table.rows.size(), 8u);
  EXPECT_EQ(table.rows[0].name, "more");
  EXPECT_EQ(table.rows[0].group, "all");
  EXPECT_NEAR(table.rows[0].values.at("score"), 40, 1e-9);
  EXPECT_EQ(table.rows[0].values.at("solved"), 120 + 42) << "without metric and public";
  const auto& few = table.rows[1].values;
  EXPECT_EQ(few.at("models"), 2);
  EXPECT_EQ(few.at("cases"), 5);
  EXPECT_EQ(few.at("solved"), 1);
  EXPECT_EQ(few.at("with_triangles"), 2);
  EXPECT_EQ(few.at("failed"), 2);
  // The gear's three cases have 100, 50 and 0, the bracket's two 0.
  EXPECT_NEAR(few.at("score"), 25, 1e-9);
  EXPECT_NEAR(table.rows[1].half_widths.at("score"), 12.706205 * 25, 1e-4);
  EXPECT_NEAR(few.at("eta_worst"), 0.5, 1e-9);
  EXPECT_NEAR(few.at("eta_mean"), 1, 1e-9);
  EXPECT_NEAR(few.at("tau"), 90, 1e-9);
  // By family: none of the CAD cases has a sound mesh, and then there is nothing to take a mean of; of
  // triangles nothing was run.
  EXPECT_EQ(table.rows[5].group, "CAD");
  EXPECT_EQ(table.rows[5].values.at("failed"), 2);
  EXPECT_EQ(table.rows[5].values.at("cases"), 2);
  EXPECT_FALSE(table.rows[5].values.contains("eta_mean"));
  EXPECT_EQ(table.rows[6].group, "triangles");
  EXPECT_EQ(table.rows[6].name, "more");
}

TEST(Ranking, TestsOverModels) {
  const TemporaryFolder folder;
  const auto write = [&](const std::string& program, std::size_t n_models, double eta) {
    write_study_of(folder / program, program, suite_title());
    for (std::size_t i = 0; i < n_models; ++i)
      for (int k = 0; k < 3; ++k)
        write_cell(folder / program, case_name(suite().models[i], k), program, metrics(eta, 100, 100));
  };
  write("all", 14, 0.8);
  write("low", 14, 0.7);
  write("six", 6, 0.9);
  const Table table = rank_programs(folder.path());
  // In both groups all models agree: p is 2^-13 over 14 models and 2^-5 over six, which is too much for a
  // family of six tests, though it would be 18 cases.
  ASSERT_EQ(table.rows.size(), 6u);
  for (const std::size_t group : {0, 3}) {
    EXPECT_EQ(table.rows[group].name, "all");
    EXPECT_EQ(table.rows[group].texts.at("better_than"), "low");
    EXPECT_EQ(table.rows[group + 2].name, "six") << "fewer cases stand below";
    EXPECT_TRUE(table.rows[group + 2].texts.empty());
  }
}

/// Who cannot be told metrics has not failed: it keeps its rank over all, and has a row without one there.
TEST(Ranking, KeepsMetricsApart) {
  const TemporaryFolder folder;
  write_study_of(folder / "a", "told", suite_title());
  write_study_of(folder / "b", "sizes", suite_title());
  Json in_metric = metrics(0.1, 20, 100);
  in_metric["metrics"].update({{"metric_eta_mean", 0.8}, {"metric_eta_worst", 0.3}, {"metric_tau", 90}});
  in_metric["metrics"]["tau"] = nullptr;
  write_cell(folder / "a", "metric_thin_1", "told", in_metric);
  write_cell(folder / "b", "metric_thin_1", "sizes",
             {{"status", "not applicable"}, {"kind", "not applicable"}, {"reason", "is told sizes"}});
  write_cell(folder / "a", "gear_1", "told", metrics(0.5, 80, 100));
  write_cell(folder / "b", "gear_1", "sizes", metrics(0.6, 80, 100));
  const Table table = rank_programs(folder.path());
  ASSERT_EQ(table.rows.size(), 6u);
  EXPECT_EQ(table.rows[0].name, "sizes");
  EXPECT_NEAR(table.rows[0].values.at("score"), 48, 1e-9);
  EXPECT_NEAR(table.rows[1].values.at("score"), 40, 1e-9);
  EXPECT_EQ(table.rows[4].group, "metric");
  EXPECT_NEAR(table.rows[4].values.at("score"), 72, 1e-9);
  EXPECT_NEAR(table.rows[4].values.at("eta_worst"), 0.3, 1e-9);
  EXPECT_EQ(table.rows[5].skipped, "not applicable");
  EXPECT_EQ(table.notes.back(), "sizes is not applicable to metric: is told sizes");
}

TEST(Ranking, ShowsWhatIsNotInstalledWithoutARank) {
  const TemporaryFolder folder;
  write_study_of(folder / "a", "absent", suite_title());
  write_study_of(folder / "b", "failing", suite_title());
  write_cell(folder / "a", "gear_1", "absent",
             {{"status", "not applicable"}, {"kind", "not applicable"}, {"reason", "not installed"}});
  write_cell(folder / "b", "gear_1", "failing",
             {{"status", "failed"}, {"kind", "peer"}, {"reason", "crashed"}});
  const Table table = rank_programs(folder.path());
  ASSERT_EQ(table.rows.size(), 3u);
  for (const TableRow& row : table.rows) EXPECT_EQ(row.name == "absent", row.skipped == "not applicable");
  EXPECT_EQ(table.rows[1].group, "all");
  EXPECT_EQ(table.rows[1].name, "absent");
  EXPECT_EQ(table.notes.back(), "absent is not applicable: not installed");
  EXPECT_NE(to_csv(table).find("all,absent,not applicable,"), std::string::npos) << to_csv(table);
}

TEST(Ranking, RefusesResultsOfSomethingElse) {
  const TemporaryFolder folder;
  EXPECT_THROW(rank_programs(folder.path()), InputError);
  write_study_of(folder / "a", "DB", "Table I");
  write_cell(folder / "a", "gear_1", "DB", metrics(1, 100, 100));
  try {
    rank_programs(folder.path());
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("'Table I', not of '" + suite_title()), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace delquad::testing_support
