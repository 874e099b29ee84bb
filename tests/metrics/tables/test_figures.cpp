#include <gtest/gtest.h>

#include <algorithm>

#include "metrics/tables/figures.h"
#include "tests/support/temporary_folder.h"

namespace delquad {
namespace {

namespace fs = std::filesystem;
using testing_support::read_text;

CellRecord cell(const std::string& name, const std::string& pipeline, double eta, double seconds) {
  CellRecord record;
  record.group = record.name = name;
  record.pipeline = pipeline;
  record.values = {{"n_quads", 100}, {"eta_mean", eta}, {"tau", 90}, {"d4", 95}, {"seconds_total", seconds}};
  return record;
}

CellRecord failed(const std::string& name, const std::string& pipeline, const std::string& kind) {
  CellRecord record;
  record.group = record.name = name;
  record.pipeline = pipeline;
  record.reason = record.kind = kind;
  record.skipped = kind == "not applicable" || kind == "data not found";
  return record;
}

const Figure& figure_of(const std::vector<Figure>& figures, const std::string& name) {
  return *std::ranges::find(figures, name, &Figure::name);
}

/// Three cases: DB and peer are the better ones in turn, and one of the peer's cells failed.
std::vector<CellRecord> three_cases() {
  return {cell("a", "DB", 0.9, 1),   cell("a", "peer", 0.8, 2), cell("b", "DB", 0.6, 4),
          cell("b", "peer", 0.9, 2), cell("c", "DB", 0.5, 1),   failed("c", "peer", "crash")};
}

TEST(Figures, ProfilesHaveThePartWithinEachFactor) {
  const Figure profile = figure_of(make_figures(three_cases()), "profile_time");
  // DB: 1, 2, 1 times the least; peer: 2, 1, never.
  ASSERT_EQ(profile.diagram.series.size(), 2u);
  const auto& db = profile.diagram.series[0].points;
  const auto& peer = profile.diagram.series[1].points;
  ASSERT_EQ(db.size(), 4u);
  EXPECT_EQ(db[2].x, 1);
  EXPECT_NEAR(db[2].y, 200.0 / 3, 1e-9);
  EXPECT_EQ(db[3].x, 2);
  EXPECT_EQ(db[3].y, 100);
  ASSERT_EQ(peer.size(), 3u) << "what failed is infinitely bad";
  EXPECT_NEAR(peer.back().y, 200.0 / 3, 1e-9);
  ASSERT_EQ(profile.diagram.notes.size(), 1u);
  EXPECT_EQ(profile.diagram.notes[0], "peer: 1 failed of 3");
}

TEST(Figures, LossesOfEtaAreWhatIsMissingToOne) {
  const Figure profile = figure_of(make_figures(three_cases()), "profile_eta");
  EXPECT_NEAR(profile.diagram.series[0].points.back().x, 4, 1e-9) << "0.4 against 0.1 on b";
  EXPECT_NEAR(profile.diagram.series[1].points.back().x, 2, 1e-9) << "0.2 against 0.1 on a";
}

TEST(Figures, DotsAreTheSoundCells) {
  std::vector<CellRecord> records = three_cases();
  records[0].unsound = {"folded"};
  const Figure dots = figure_of(make_figures(records), "time_quality");
  EXPECT_EQ(dots.diagram.series[0].points.size(), 2u);
  EXPECT_EQ(dots.csv.substr(0, dots.csv.find('\n', 24)), "case,pipeline,x,y\n\"b\",DB,4,0.6");
  EXPECT_EQ(dots.diagram.notes, (std::vector<std::string>{"DB: 1 not sound of 3", "peer: 1 failed of 3"}));
}

TEST(Figures, NeedThreeCasesAndTwoPipelines) {
  std::vector<CellRecord> records = three_cases();
  EXPECT_EQ(make_figures(records).size(), 5u);
  records.resize(4);
  EXPECT_TRUE(make_figures(records).empty());
  records = three_cases();
  std::erase_if(records, [](const CellRecord& r) { return r.pipeline == "peer"; });
  EXPECT_TRUE(make_figures(records).empty());
}

/// What was not there for anybody says nothing of anybody; what a peer cannot be told counts, and is named.
TEST(Figures, TellAbsentDataFromWhatIsNotApplicable) {
  std::vector<CellRecord> records = three_cases();
  for (const char* pipeline : {"DB", "peer"}) records.push_back(failed("d", pipeline, "data not found"));
  records.push_back(cell("e", "DB", 0.9, 1));
  records.push_back(failed("e", "peer", "not applicable"));
  records.push_back(cell("f", "DB", 0.9, 1));  // the peer's is not made yet
  const Figure profile = figure_of(make_figures(records), "profile_tau");
  EXPECT_EQ(profile.diagram.notes[0], "peer: 1 failed, 1 not applicable of 4");
}

TEST(Figures, GoWhenThereAreNoneAnyLonger) {
  const testing_support::TemporaryFolder folder;
  EXPECT_TRUE(write_figures(folder.path(), make_figures(three_cases())).empty());
  const std::string svg = read_text(folder / kFigures / "profile_time.svg");
  EXPECT_NE(svg.find("peer: 1 failed of 3"), std::string::npos);
  EXPECT_NE(svg.find("times the least"), std::string::npos);
  EXPECT_TRUE(read_text(folder / kFigures / "profile_time.pdf").starts_with("%PDF-"));
  EXPECT_EQ(read_text(folder / kFigures / "profile_time.csv").substr(0, 24), "pipeline,factor,percent\n");
  EXPECT_TRUE(write_figures(folder.path(), {}).empty());
  EXPECT_FALSE(fs::exists(folder / kFigures));
}

}  // namespace
}  // namespace delquad
