#include "experiments/sweep/repeat_times.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>

#include "metrics/tables/result_records.h"
#include "tests/support/expect_input_error.h"
#include "tests/support/run_program.h"

namespace delquad {
namespace {

namespace fs = std::filesystem;
using testing_support::read_text;
using testing_support::run_program;
using testing_support::TemporaryFolder;
using testing_support::write_text;

const std::string kStudy =
    "pipelines = [\"FB\", \"DB\", \"DBC\"]\nrepeat_times = 4\n"
    "[[case]]\nname = \"square\"\nsize = 0.2\nloop = { rectangle = [[0, 0], [1, 1]] }\n";

class RepeatTimes : public testing::Test {
 protected:
  void run(const std::string& text) {
    const auto file = write_text(folder_ / "study.toml", text);
    const auto result = run_program(DELQUAD_PROGRAM, {{"run", file.string(), "-o", out()}, 0, {}});
    ASSERT_EQ(result.exit_code, 0) << result.err;
  }
  std::string out() const { return (folder_ / "out").string(); }
  std::string times() const { return out() + "/square/times.json"; }
  std::string table() const { return read_text(out() + "/table.md"); }

  TemporaryFolder folder_;
};

TEST(OrderOfRound, IsAPermutationThatChanges) {
  std::set<std::vector<std::size_t>> orders;
  for (std::size_t round = 0; round < 20; ++round) {
    std::vector<std::size_t> order = order_of_round(4, 3, round);
    EXPECT_EQ(order, order_of_round(4, 3, round));
    orders.insert(order);
    std::ranges::sort(order);
    EXPECT_EQ(order, (std::vector<std::size_t>{0, 1, 2, 3}));
  }
  EXPECT_GT(orders.size(), 10u);
  EXPECT_TRUE(order_of_round(0, 0, 0).empty());
}

TEST_F(RepeatTimes, EveryPipelineIsRunSoOften) {
  run(kStudy);
  const auto read = read_times(out() + "/square");
  ASSERT_TRUE(read);
  EXPECT_EQ(read->repetitions, 4);
  ASSERT_EQ(read->cells.size(), 3u);
  for (const CellTimes& cell : read->cells)
    for (const char* key : {"seconds", "seconds_total"}) EXPECT_EQ(cell.seconds.at(key).size(), 4u) << key;
  EXPECT_NE(table().find("s, median"), std::string::npos) << table();
  EXPECT_NE(table().find("median and least of 4 runs"), std::string::npos) << table();
  EXPECT_FALSE(fs::exists(out() + "/square/.times"));

  const auto first = fs::last_write_time(times());
  run(kStudy);
  EXPECT_EQ(fs::last_write_time(times()), first) << "is not done again";
}

TEST_F(RepeatTimes, DamagedFilesAreNamedAndTheRestIsShown) {
  run(kStudy);
  for (const char* damage :
       {"{\"repetitions\": 4", "{}", "[]",
        "{\"repetitions\": 2, \"load_average\": [0, 0], \"cells\": [{\"pipeline\": \"DB\", "
        "\"key\": \"k\", \"seconds\": [1]}]}"}) {
    write_text(times(), damage);
    const auto result = run_program(DELQUAD_PROGRAM, {{"tables", out()}, 0, {}});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(result.out.find(": is no file of repeated times: "), std::string::npos) << result.out;
    EXPECT_NE(result.out.find("| square | DBC"), std::string::npos) << result.out;
  }
  run(kStudy);
  EXPECT_TRUE(read_times(out() + "/square")) << "made again";
}

TEST_F(RepeatTimes, TimesOfOtherCellsAreNotShown) {
  run(kStudy);
  std::string other = read_text(times());
  const auto at = other.find("\"key\": \"") + 8;
  other[at] = other[at] == '0' ? '1' : '0';
  write_text(times(), other);
  const auto result = run_program(DELQUAD_PROGRAM, {{"tables", out()}, 0, {}});
  EXPECT_NE(result.out.find("the times of FB were taken of another program"), std::string::npos)
      << result.out;
}

TEST_F(RepeatTimes, OnceIsNoRepetition) {
  std::string once = kStudy;
  once.replace(once.find("= 4"), 3, "= 1");
  const auto file = write_text(folder_ / "study.toml", once);
  expect_input_error([&] { Experiment::read(file); }, {"repeat_times", "expected 2 to"});
}

TEST_F(RepeatTimes, ColumnsAreChecked) {
  const auto read = [&](const std::string& columns) {
    return Experiment::read(write_text(folder_ / "study.toml", "columns = " + columns + "\n" + kStudy));
  };
  EXPECT_EQ(read("[\"n_quads\", \"seconds\", \"seconds_matching\", \"aspect_max\"]").columns.size(), 4u);
  expect_input_error([&] { read("[\"eta_maen\"]"); },
                     {"study.toml:1", "eta_maen", "did you mean 'eta_mean'"});
  expect_input_error([&] { read("[\"d4\", \"d4\"]"); }, {"'d4' twice"});
  expect_input_error([&] { read("[]"); }, {"'columns' is empty"});
}

TEST_F(RepeatTimes, ChosenColumnsAreShown) {
  run("columns = [\"aspect_max\", \"eta_mean\", \"seconds\"]\n" + kStudy);
  EXPECT_NE(table().find("|   n | aspect max | eta mean | s, median | s, least |"), std::string::npos)
      << table();
  EXPECT_NE(read_text(out() + "/table.csv").find("n_vertices"), std::string::npos);
}

}  // namespace
}  // namespace delquad
