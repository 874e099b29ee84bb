// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrics/tables/runs.h"
#include "metrics/tables/summary.h"
#include "metrics/tables/tables.h"
#include "tests/support/files.h"

namespace delquad {
namespace {

/// Words A, B and C with eta on `domains` domains that are read off a function, one seed each.
template <class Eta>
StudyResults study_of(int domains, Eta eta) {
  StudyResults results;
  results.study.title = "Made up";
  results.study.pipelines = {"A", "B", "C"};
  results.study.axes = {{"size", {"0.1"}}, {"seed", {"1"}}};
  results.study.columns = {"eta_mean"};
  for (int d = 0; d < domains; ++d)
    for (int w = 0; w < 3; ++w) {
      CellRecord record;
      record.name = "d" + std::to_string(d);
      record.group = record.name + "@size=0.1,seed=1";
      record.pipeline = results.study.pipelines[static_cast<std::size_t>(w)];
      record.variant = {{"size", "0.1"}, {"seed", "1"}};
      record.seed = 1;
      record.values = {{"n_quads", 100}, {"n_triangles", 0}, {"seconds", 0.1}, {"eta_mean", eta(w, d)}};
      results.records.push_back(record);
    }
  results.study.cells = results.records.size();
  return results;
}

std::vector<Strings> fields_of(const std::string& csv) {
  std::vector<Strings> lines;
  std::istringstream in(csv);
  for (std::string line; std::getline(in, line);) {
    lines.emplace_back();
    bool quoted = false;
    std::string field;
    for (const char c : line + ",") {
      if (c == '"')
        quoted = !quoted;
      else if (c != ',' || quoted)
        field += c;
      else
        lines.back().push_back(std::exchange(field, ""));
    }
  }
  return lines;
}

TEST(RunsCsv, HasALineForEachCellAndOneForEachColumn) {
  StudyResults results = study_of(2, [](int w, int d) { return 0.1 + w + d / 3.0; });
  results.records[1].reason = "signal 11, \"segmentation\"\nand more";
  results.records[1].kind = "crash";
  results.records[1].values.clear();
  results.records[2].unsound = {"folded", "open"};
  results.records[3].domain = "d0";
  results.records[4].is_peer = true;
  results.records[5].reason = results.records[5].kind = kNotApplicable;
  results.records[5].skipped = true;
  const RunsCsv csv = runs_csv(results.study, results.records);
  const auto lines = fields_of(csv.lines), columns = fields_of(csv.columns);
  ASSERT_EQ(lines.size(), 7u);
  ASSERT_EQ(columns.size(), lines[0].size() + 1);
  for (const auto& line : lines) EXPECT_EQ(line.size(), lines[0].size());
  for (std::size_t k = 0; k < lines[0].size(); ++k) {
    EXPECT_EQ(columns[k + 1][0], lines[0][k]);
    EXPECT_EQ(columns[k + 1].size(), columns[0].size());
    EXPECT_FALSE(columns[k + 1][2].empty()) << "it means nothing: " << lines[0][k];
  }
  const auto at = [&](std::size_t line, const std::string& key) {
    return lines[line + 1][static_cast<std::size_t>(std::ranges::find(lines[0], key) - lines[0].begin())];
  };
  EXPECT_EQ(at(0, "size"), "0.1");
  EXPECT_EQ(at(0, "status"), "ok");
  EXPECT_EQ(at(1, "reason"), "crash: signal 11, segmentation");
  EXPECT_EQ(at(1, "eta_mean"), "");
  EXPECT_EQ(at(2, "status") + " " + at(2, "reason"), "unsound folded; open");
  EXPECT_EQ(at(3, "domain"), "d0");
  EXPECT_EQ(std::stod(at(3, "eta_mean")), 0.1 + 0 + 1 / 3.0) << "every digit";
  EXPECT_EQ(at(4, "kind"), "peer");
  EXPECT_EQ(at(5, "status"), "not applicable");
  EXPECT_TRUE(holds(
      csv.columns,
      "\neta_mean,eta mean,\"paper 6.1, equation (4), mean over quads\",,number,0,1,higher,yes,pairs\n"));
  EXPECT_EQ(std::ranges::count(lines[0], "seed"), 1);
}

/// A is best on all domains, by a tie on one; B and C take turns, B the more often.
TEST(Summary, CountsDomainsAndListsWhatIsProven) {
  const StudyResults results = study_of(12, [](int w, int d) {
    if (w == 0) return d == 0 ? 0.5 : 0.9;
    return (d % 3 == 0) == (w == 2) ? 0.5 : 0.4;
  });
  const Outcome outcome = make_tables(results);
  std::vector<TableRow> rows = outcome.summary.rows;
  std::erase_if(rows, [](const TableRow& row) { return row.group != "eta mean"; });
  ASSERT_EQ(rows.size(), 3u);
  const auto of = [&](std::size_t row, const char* key) { return value_or_nan(rows[row].values, key); };
  EXPECT_EQ(of(0, "domains"), 12);
  EXPECT_NEAR(of(0, "mean"), (0.5 + 11 * 0.9) / 12, 1e-12);
  std::vector<double> etas(12, 0.9);
  etas[0] = 0.5;
  EXPECT_EQ(of(0, "low"), interval_of_mean(etas)->low);
  EXPECT_EQ(of(0, "high"), std::min(1.0, interval_of_mean(etas)->high));
  EXPECT_EQ(of(0, "won"), 11) << "and a tie with C";
  EXPECT_EQ(of(0, "lost"), 0);
  EXPECT_EQ(of(1, "won"), 0);
  EXPECT_EQ(of(1, "lost"), 4);
  EXPECT_EQ(of(2, "lost"), 8);
  EXPECT_EQ(rows[0].texts.at("better_than"), "B, C");
  EXPECT_EQ(rows[1].texts.at("better_than"), "-");
  EXPECT_TRUE(rows[0].bold.contains("mean"));
  // Whatever a caption cites is beside it.
  const std::string &text = outcome.files.at("tables.tex"), &works = outcome.files.at("references.bib");
  std::size_t cited = 0;
  for (std::size_t at = 0; (at = text.find("\\cite{", at)) != text.npos; ++cited) {
    at += 6;
    EXPECT_NE(works.find(text.substr(at, text.find('}', at) - at) + ","), std::string::npos);
  }
  EXPECT_GE(cited, 4u);
  EXPECT_TRUE(make_tables(study_of(1, [](int w, int) { return 0.1 * w; })).summary.rows.empty());
}

}  // namespace
}  // namespace delquad
