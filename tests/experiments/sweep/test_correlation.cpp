#include "metrics/tables/correlation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "experiments/sweep/run_experiment.h"
#include "tests/support/expect_input_error.h"
#include "tests/support/temporary_folder.h"

namespace delquad {
namespace {

CellRecord record(const std::string& domain, const std::string& word, int seed,
                  std::map<std::string, double> values) {
  CellRecord r;
  r.name = domain;
  r.variant = {{"seed", std::to_string(seed)}};
  r.group = domain + "@seed=" + std::to_string(seed);
  r.pipeline = word;
  r.values = std::move(values);
  return r;
}

/// `of` falls with `with` in every domain by the same law, but for an offset of the domain which alone would
/// make them rise together.
std::vector<CellRecord> offset_domains() {
  std::vector<CellRecord> records;
  for (int d = 0; d < 8; ++d)
    for (int k = 0; k < 6; ++k)
      records.push_back(record("domain" + std::to_string(d), k < 3 ? "A" : "B", k % 3,
                               {{"x", 10.0 * d + k}, {"y", 100.0 * d - k * k}, {"same", 1}}));
  return records;
}

TEST(Correlation, RanksShareTies) {
  EXPECT_EQ(ranks(std::vector<double>{3, 1, 3, 2}), (std::vector<double>{3.5, 1, 3.5, 2}));
  EXPECT_TRUE(ranks({}).empty());
}

/// The second: 1 - 6 * sum of squares / (n (n^2 - 1)) without ties; the third: scipy.stats.spearmanr.
TEST(Correlation, IsSpearmans) {
  using V = std::vector<double>;
  EXPECT_DOUBLE_EQ(spearman(V{1, 2, 3, 4}, V{1, 8, 27, 64}).value(), 1);
  EXPECT_DOUBLE_EQ(spearman(V{1, 2, 3, 4, 5}, V{2, 1, 4, 3, 5}).value(), 1 - 6.0 * 4 / (5 * 24));
  EXPECT_NEAR(spearman(V{1, 2, 2, 3}, V{4, 3, 1, 1}).value(), -0.8333333333333334, 1e-12);
  EXPECT_FALSE(spearman(V{1, 2, 3}, V{1, 1, 1}).has_value());
  EXPECT_FALSE(spearman(V{1, 2}, V{1, 2}).has_value());
}

TEST(Correlation, IsWithinDomains) {
  const auto found = correlate({{"y"}, {"x", "same"}}, offset_domains());
  ASSERT_EQ(found.size(), 2u);
  EXPECT_DOUBLE_EQ(found[0].mean, -1);
  EXPECT_EQ(found[0].by_domain.size(), 8u);
  EXPECT_EQ(found[0].runs, 48u);
  EXPECT_DOUBLE_EQ(found[0].interval.value().low, -1);
  EXPECT_TRUE(found[1].by_domain.empty());
  EXPECT_TRUE(std::isnan(found[1].mean));
  EXPECT_FALSE(found[1].interval.has_value());
  std::vector<CellRecord> five = offset_domains();
  std::erase_if(five, [](const CellRecord& r) { return r.name > "domain4"; });
  EXPECT_FALSE(correlate({{"y"}, {"x"}}, five)[0].interval.has_value());
  const Table table = correlation_table("t", found);
  EXPECT_NE(to_markdown(table).find("y with same: 8 of 8 domains are left out"), std::string::npos);
}

/// Errors that fall only because there are more vertices say nothing of the meshes.
TEST(Correlation, LeavesTheNumberOfVerticesOut) {
  std::vector<CellRecord> records;
  for (int k = 0; k < 6; ++k) {
    const double n = 100 * std::pow(4, k);
    // Exact powers of two: nothing is left of h1 * sqrt(n).
    records.push_back(record("d", "A", k, {{"x", k}, {"n_vertices", n}, {"poisson_h1", 10 / std::sqrt(n)}}));
  }
  EXPECT_TRUE(correlate({{"poisson_h1"}, {"x"}}, records)[0].by_domain.empty());
  for (int k = 0; k < 6; ++k) records[static_cast<std::size_t>(k)].values["poisson_h1"] *= 1 + k;
  EXPECT_DOUBLE_EQ(correlate({{"poisson_h1"}, {"x"}}, records)[0].mean, 1);
}

TEST(Correlation, IsAskedForByExperiments) {
  const testing_support::TemporaryFolder folder;
  const std::string cases =
      "[matrix]\nseed = [1, 2]\n"
      "[[case]]\nname = \"a\"\nloop = { rectangle = [[0, 0], [1, 1]] }\nsize = 0.15\n"
      "[[case]]\nname = \"b\"\nloop = { circle = { centre = [0, 0], radius = 1 } }\nsize = 0.3\n";
  const auto read = [&](const std::string& correlate) {
    return Experiment::read(testing_support::write_text(
        folder / "e.toml",
        "pipelines = [\"FB\", \"DB\"]\nsolver = [\"poisson\"]\n[correlate]\n" + correlate + cases));
  };
  run_experiment(read("of = [\"poisson_h1\"]\nwith = [\"eta_mean\", \"d4\"]\n"), folder / "out");
  for (const char* extension : {".md", ".csv", ".tex", ".json"})
    EXPECT_TRUE(std::filesystem::exists(folder / "out" / ("correlations" + std::string(extension))));
  const auto rows = nlohmann::json::parse(std::ifstream(folder / "out" / "correlations.json"))["rows"];
  ASSERT_EQ(rows.size(), 2u);
  // From records and study.json alone.
  EXPECT_EQ(to_json(make_tables(folder / "out").correlations),
            to_json(read_table(folder / "out" / "correlations.json")));
  expect_input_error([&] { read("of = [\"elasticity_h1\"]\nwith = [\"d4\"]\n"); }, {"elasticity_h1"});
  expect_input_error([&] { read("of = []\nwith = [\"d4\"]\n"); }, {"'of' is empty"});
  expect_input_error([&] { read("of = [\"d4\"]\n"); }, {"with"});
}

}  // namespace
}  // namespace delquad
