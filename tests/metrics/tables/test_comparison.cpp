// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrics/tables/comparison.h"
#include "tests/support/files.h"

namespace delquad {
namespace {

CellRecord cell(const std::string& word, double eta, double seconds = 1) {
  return {"plate", word, "", {{"eta_mean", eta}, {"d_max", 5}, {"seconds", seconds}}};
}

TEST(Compare, JudgesByDirectionAndTolerance) {
  const std::vector<CellRecord> before = {cell("FB", 0.8), cell("DB", 0.9, 2)};
  const std::vector<CellRecord> after = {cell("FB", 0.7), cell("DB", 0.905, 1)};
  const Comparison c = compare_records(before, after, {"eta_mean", "seconds"}, 0.01);
  ASSERT_EQ(c.changes.size(), 4u);
  EXPECT_EQ(c.changes[0].verdict, Verdict::kWorse) << "a fact of single runs";
  EXPECT_EQ(c.changes[1].verdict, Verdict::kUnchanged);
  EXPECT_EQ(c.changes[2].verdict, Verdict::kUnchanged) << "half a percent";
  EXPECT_EQ(c.changes[3].verdict, Verdict::kNotProven) << "the time of single runs";
  EXPECT_TRUE(c.regressed());
  EXPECT_TRUE(holds(to_text(c), "changed    plate FB: eta_mean 0.8 -> 0.7  (worse; one run)"));
  EXPECT_FALSE(holds(to_text(c), "regressed  "));
  EXPECT_FALSE(compare_records({cell("D", 1, 1)}, {cell("D", 1, 9)}, {"seconds"}, 0.01).regressed());
  EXPECT_FALSE(compare_records(before, before, {"eta_mean", "seconds"}, 0).regressed());
}

/// Several domains and seeds: eta as the function says.
std::vector<CellRecord> sweep(int domains, int seeds, const std::function<double(int, int)>& eta) {
  std::vector<CellRecord> records;
  for (int d = 0; d < domains; ++d)
    for (int s = 0; s < seeds; ++s) {
      const std::string name = "case" + std::to_string(d), seed = std::to_string(s);
      CellRecord record{name + "@seed=" + seed, "DB", "", {{"eta_mean", eta(d, s)}}};
      record.name = name;
      record.variant = {{"seed", seed}};
      records.push_back(record);
    }
  return records;
}

TEST(Compare, WhatIsSoInEveryRunIsAFact) {
  const auto before = sweep(1, 12, [](int, int s) { return 0.5 + 0.01 * s; });
  const auto better = sweep(1, 12, [](int, int s) { return 0.6 + 0.011 * s; });
  const Comparison up = compare_records(before, better, {"eta_mean"}, 0.01);
  ASSERT_EQ(up.changes.size(), 1u) << "a row, not twelve cells";
  EXPECT_EQ(up.changes[0].verdict, Verdict::kBetter);
  EXPECT_EQ(up.changes[0].runs, 12u);
  EXPECT_TRUE(holds(to_text(up), "(better; 12 runs)"));
  const Comparison down = compare_records(better, before, {"eta_mean"}, 0.01);
  EXPECT_EQ(down.changes[0].verdict, Verdict::kWorse);
  EXPECT_TRUE(down.regressed());
}

TEST(Compare, ScatterIsNoRegression) {
  const auto before = sweep(1, 12, [](int, int) { return 0.5; });
  const auto after = sweep(1, 12, [](int, int s) { return s % 2 ? 0.7 : 0.2 + 0.01 * s; });
  const Comparison c = compare_records(before, after, {"eta_mean"}, 0.01);
  EXPECT_EQ(c.changes[0].verdict, Verdict::kNotProven);
  EXPECT_FALSE(c.regressed());
}

TEST(Compare, DomainsProveChangesOfSingleRuns) {
  const auto before = sweep(12, 1, [](int d, int) { return 0.5 + 0.01 * d; });
  const auto after = sweep(12, 1, [](int d, int) { return 0.4 + 0.012 * d; });
  const Comparison c = compare_records(before, after, {"eta_mean"}, 0.01);
  ASSERT_EQ(c.over_domains.size(), 1u);
  EXPECT_EQ(c.over_domains[0].verdict, Verdict::kRegressed);
  EXPECT_EQ(c.over_domains[0].pair.domains.names.size(), 12u);
  EXPECT_NEAR(mean(c.over_domains[0].pair.domains.differences), -0.1 + 0.002 * 5.5, 1e-12);
  EXPECT_TRUE(holds(to_text(c), "regressed  DB over 12 domains: eta_mean -0.0"));
  const auto one = [&](int n) { return sweep(n, 1, [](int d, int) { return 0.5 + 0.01 * d; }); };
  EXPECT_TRUE(compare_records(one(5), one(5), {"eta_mean"}, 0.01).over_domains.empty());
}

/// Better wherever it did not fail: nothing of that is proven.
TEST(Compare, CellsThatFailLose) {
  const auto before = sweep(12, 1, [](int d, int) { return 0.5 + 0.01 * d; });
  auto after = sweep(12, 1, [](int d, int) { return 0.6 + 0.012 * d; });
  EXPECT_EQ(compare_records(before, after, {"eta_mean"}, 0.01).over_domains[0].verdict, Verdict::kImproved);
  for (std::size_t d = 0; d < 6; ++d) {
    after[d].values.clear();
    after[d].reason = "crash";
  }
  const Comparison c = compare_records(before, after, {"eta_mean"}, 0.01);
  EXPECT_EQ(c.over_domains[0].verdict, Verdict::kNotProven);
  EXPECT_TRUE(holds(to_text(c), "(not proven; 6 runs; after failed on 6)"));
}

TEST(Compare, TellsWhatIsMissingFailedAndNew) {
  CellRecord broken = cell("D", 0);
  broken.values.clear();
  broken.reason = "no size";
  const std::vector<CellRecord> before = {cell("D", 0.8), cell("F", 0.8)};
  const Comparison c = compare_records(before, {broken, cell("DB", 1)}, {"eta_mean"}, 0.01);
  EXPECT_EQ(c.missing, Strings{"plate F"});
  EXPECT_EQ(c.failed, Strings{"plate D: no size"});
  EXPECT_EQ(c.added, Strings{"plate DB"});
  EXPECT_TRUE(c.regressed());
  EXPECT_EQ(compare_records({broken}, {cell("D", 1)}, {"eta_mean"}, 0.01).recovered, Strings{"plate D"});
  EXPECT_FALSE(compare_records({broken}, {broken}, {"eta_mean"}, 0.01).regressed());
}

TEST(Compare, AValueThatIsNoLongerDefinedIsARegression) {
  EXPECT_TRUE(compare_records({cell("D", 0.5)}, {cell("D", std::nan(""))}, {"eta_mean"}, 1).regressed());
  EXPECT_FALSE(compare_records({cell("D", std::nan(""))}, {cell("D", 0.5)}, {"eta_mean"}, 1).regressed());
}

TEST(Compare, RefusesMetricsWithoutADirection) {
  for (const char* metric : {"n_quads", "beauty"})
    expect_input_error([&] { compare_records({}, {}, {metric}, 0.1); }, {metric, "eta_mean", "seconds"});
  expect_input_error([&] { compare_records({}, {}, {"eta_maen"}, 0.1); }, {"did you mean 'eta_mean'?"});
}

TEST(ReadRecords, NameWhatIsNoRecord) {
  const Folder folder;
  expect_input_error([&] { read_records(folder / "nowhere"); }, {"nowhere"});
  expect_input_error([&] { read_records(folder / ""); }, {"no record.json"});
  fs::create_directories(folder / "a" / "b");
  const std::string good =
      R"({"record": 3, "case": "a", "pipeline": "D", "status": "ok", "metrics": {"tau": null, "d4": 90}, "meshing_seconds": 2})";
  write_text(folder / "a" / "record.json", good);
  const auto records = read_records(folder / "");
  ASSERT_EQ(records.size(), 1u);
  EXPECT_TRUE(std::isnan(records[0].values.at("tau")));
  EXPECT_EQ(records[0].values.at("seconds"), 2);
  write_text(folder / "a" / "b" / "record.json", good);
  expect_input_error([&] { read_records(folder / ""); }, {"another record of a D"});
  for (const char* text : {"", "{}", "[1]", "{\"case\": 3}", "\x01"}) {
    write_text(folder / "a" / "b" / "record.json", text);
    const auto both = read_records(folder / "");
    ASSERT_EQ(both.size(), 2u);
    EXPECT_EQ(both[0].kind, "damaged");
    EXPECT_EQ(both[0].reason.find("damaged record: " + (folder / "a" / "b" / "record.json").string()), 0u);
    EXPECT_EQ(both[1].reason, "");
  }
}

}  // namespace
}  // namespace delquad
