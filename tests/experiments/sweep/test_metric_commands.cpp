// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/sweep/metric_command.h"
#include "experiments/sweep/run_experiment.h"
#include "metrics/tables/comparison.h"
#include "tests/support/files.h"

namespace delquad {
namespace {

TEST(MetricOutput, IsANumberOrAnObject) {
  const auto values = [](const std::string& text) { return parse_metric_output("m", text).values; };
  using Values = std::map<std::string, double>;
  EXPECT_EQ(values("2.5\n"), (Values{{"m", 2.5}}));
  EXPECT_EQ(values("  -1e-3"), (Values{{"m", -1e-3}}));
  EXPECT_EQ(values("solving ...\n3\n\n"), (Values{{"m", 3}}));
  EXPECT_EQ(values("{\"l2\": 1, \"h1\": 2.5}"), (Values{{"m.l2", 1}, {"m.h1", 2.5}}));
  EXPECT_EQ(values("{\n  \"l2\": 1\n}\n"), (Values{{"m.l2", 1}}));
  EXPECT_TRUE(std::isnan(values("nan\n").at("m")));
  EXPECT_TRUE(std::isnan(values("{\"l2\": null}").at("m.l2")));
}

TEST(MetricOutput, AnythingElseIsAFailure) {
  const auto failure = [](const std::string& text) {
    const MetricOutcome outcome = parse_metric_output("m", text);
    EXPECT_TRUE(outcome.values.empty()) << text;
    return outcome.failure;
  };
  for (const char* text : {"", " \n\t\n"}) EXPECT_EQ(failure(text), "printed nothing");
  for (const char* text :
       {"hello", "1,5", "1 2", "0x", "[1]", "\"1\"", "true", "{\"a\": 1", "{\"a\": NaN}", "--5"})
    EXPECT_TRUE(holds(failure(text), "neither a number nor")) << text;
  EXPECT_TRUE(holds(failure("inf"), "infinite"));
  EXPECT_TRUE(holds(failure("{}"), "empty"));
  EXPECT_TRUE(holds(failure("{\"a\": \"x\"}"), "'a'"));
  EXPECT_TRUE(holds(failure("{\"a\": {\"b\": 1}}"), "'a'"));
  EXPECT_TRUE(holds(failure("{\"a b\": 1}"), "'a b'"));
  EXPECT_TRUE(holds(failure("{\"\": 1}"), "expected letters"));
  EXPECT_TRUE(holds(failure(std::string(3, '\0')), "neither"));
  EXPECT_LT(failure(std::string(100'000, 'x')).size(), 1000u);
}

class MetricCommands : public testing::Test {
 protected:
  static constexpr const char* kSquare =
      "[[case]]\nname = 'square'\nloop = { rectangle = [[0, 0], [1, 1]] }\nsize = 0.25\n";

  fs::path write(const std::string& metrics, const std::string& words = "[\"D\", \"DB\"]") {
    return write_text(folder_ / "e.toml", "pipelines = " + words + "\n" + metrics + kSquare);
  }
  static std::string metric(const std::string& name, const std::string& script,
                            const std::string& more = "") {
    return "[[metric]]\nname = \"" + name + "\"\ncommand = [\"sh\", \"-c\", '''" + script +
           "''', \"sh\", \"{mesh}\"]\n" + more + "\n";
  }
  Outcome run(const fs::path& file) { return run_experiment(Experiment::read(file), folder_ / "out"); }
  Json record(const std::string& word) {
    return Json::parse(std::ifstream(folder_ / "out" / "square" / word / "record.json"));
  }
  fs::path record_file(const std::string& word) { return folder_ / "out" / "square" / word / "record.json"; }
  static bool notes(const Outcome& outcome, const std::string& part) {
    return std::ranges::any_of(outcome.table.notes,
                               [&](const std::string& note) { return note.find(part) != note.npos; });
  }
  Folder folder_;
};

TEST_F(MetricCommands, AreColumnsLikeOthers) {
  const Outcome outcome = run(write(
      metric("lines", "grep -c '' \"$1\"", "title = 'lines of the file'\nbetter = 'lower'\ndigits = 1") +
      metric("parts", "echo '{\"a\": 1, \"b\": 2}'")));
  EXPECT_EQ(outcome.bad_inputs + outcome.others_failed, 0);
  const Json db = record("DB");
  std::ifstream mesh(folder_ / "out" / "square" / "DB" / "mesh.msh");
  const auto lines = std::count(std::istreambuf_iterator<char>(mesh), {}, '\n');
  EXPECT_EQ(db["metrics"]["lines"], lines);
  EXPECT_EQ(db["metrics"]["parts.a"], 1);
  EXPECT_EQ(db["metrics"]["parts.b"], 2);
  EXPECT_TRUE(db["seconds"].contains("metrics by command"));
  EXPECT_FALSE(db.contains("failed_metrics"));
  Strings titles;
  for (const TableColumn& column : outcome.table.columns) titles.push_back(column.title);
  for (const char* title : {"lines of the file", "parts.a", "parts.b"})
    EXPECT_EQ(std::ranges::count(titles, title), 1) << title;
  EXPECT_EQ(std::ranges::count(titles, "parts"), 0);
  EXPECT_EQ(outcome.table.rows.at(1).values.at("lines"), static_cast<double>(lines));
  const auto records = read_records(folder_ / "out");
  const Comparison same = compare_records(records, records, {"lines"}, 0.01);
  EXPECT_EQ(same.changes.size(), 2u);
  expect_input_error([&] { compare_records(records, records, {"parts.a"}, 0.01); },
                     {"'parts.a' cannot be compared"});
}

TEST_F(MetricCommands, FailuresAreNamedAndTheMeshIsThere) {
  const Outcome outcome =
      run(write(metric("broken", "echo error: first >&2; echo second >&2; exit 3") +
                    metric("silent", "true") + metric("chatty", "echo hello") + metric("none", "echo nan") +
                    metric("slow", "sleep 60", "timeout = 1") + metric("killed", "kill -9 $$") +
                    "[[metric]]\nname = 'absent'\ncommand = ['no-such-program', '{mesh}']\n" +
                    "[[metric]]\nname = \"python\"\ncommand = [\"python3\", \"-c\", \"raise "
                    "ValueError('singular')\", \"{mesh}\"]\n" +
                    metric("good", "echo 1"),
                "[\"DB\"]"));
  EXPECT_EQ(outcome.bad_inputs + outcome.others_failed, 0);
  EXPECT_EQ(outcome.metrics_failed, 1) << "cells";
  const Json db = record("DB");
  EXPECT_EQ(db["status"], "ok");
  const Json failed = db["failed_metrics"];
  const auto expect = [&](const char* name, const char* part) {
    ASSERT_TRUE(failed.contains(name)) << name;
    EXPECT_TRUE(holds(failed[name].get<std::string>(), part)) << failed[name];
    EXPECT_TRUE(notes(outcome, "no '" + std::string(name) + "' of square DB: ")) << name;
    EXPECT_FALSE(db["metrics"].contains(name)) << name;
  };
  expect("broken", "ended with exit code 3: error: first");
  expect("silent", "printed nothing");
  expect("chatty", "neither a number nor a JSON object of numbers: hello");
  expect("slow", "timeout of 1 s");
  expect("killed", "signal 9");
  expect("absent", "not found");
  expect("python", "exit code 1: ValueError: singular");
  EXPECT_EQ(failed.size(), 7u);
  EXPECT_TRUE(db["metrics"]["none"].is_null());
  EXPECT_EQ(db["metrics"]["good"], 1);
  EXPECT_GT(db["metrics"]["n_quads"], 0);
  EXPECT_TRUE(fs::exists(folder_ / "out" / "square" / "DB" / "metric-broken.err"));
  EXPECT_FALSE(fs::exists(folder_ / "out" / "square" / ".DB.work"));
}

/// All that determines a value belongs to the cell's key; a cell whose measures have failed is tried again.
TEST_F(MetricCommands, AreMadeAgainWhenTheirFilesChange) {
  const auto script = write_text(folder_ / "measure.sh", "echo 1\n");
  write_text(folder_ / "data.txt", "x");
  const std::string text =
      "[[metric]]\nname = 'm'\ncommand = ['sh', 'measure.sh', '{mesh}']\nfiles = ['data.txt']\n";
  const fs::path file = write(text, "[\"DB\"]");
  const auto run_again = [&] {
    run(file);
    return record("DB");
  };
  const Json first = run_again();
  EXPECT_EQ(first["metrics"]["m"], 1);
  const auto time = fs::last_write_time(record_file("DB"));
  EXPECT_EQ(run_again()["key"], first["key"]);
  EXPECT_EQ(fs::last_write_time(record_file("DB")), time);

  write_text(script, "echo 22; cat data.txt >/dev/null\n");
  const Json second = run_again();
  EXPECT_NE(second["key"], first["key"]);
  EXPECT_TRUE(holds(second["failed_metrics"]["m"].dump(), "data.txt"))
      << "it runs in the cell's folder, not beside the experiment: " << second["failed_metrics"];

  write_text(script, "test -e \"$1\" && echo 22\n");
  const Json third = run_again();
  EXPECT_EQ(third["metrics"]["m"], 22);
  write_text(folder_ / "data.txt", "another");
  EXPECT_NE(run_again()["key"], third["key"]);
}

TEST_F(MetricCommands, CellsWithFailedOnesAreTriedAgain) {
  const std::string flag = (folder_ / "flag").string();
  const fs::path file = write(metric("m", "test -e " + flag + " && echo 5"), "[\"DB\"]");
  run(file);
  EXPECT_EQ(record("DB")["metrics_status"], "failed");
  EXPECT_TRUE(holds(list_cells(Experiment::read(file), folder_ / "out"), "metric failed"));
  write_text(flag, "");
  run(file);
  EXPECT_EQ(record("DB")["metrics"]["m"], 5);
  EXPECT_FALSE(record("DB").contains("metrics_status"));
  EXPECT_TRUE(holds(list_cells(Experiment::read(file), folder_ / "out"), "done"));
}

TEST_F(MetricCommands, PlaceholdersAreFilledIn) {
  run(write(
      "seed = 0\n[[metric]]\nname = 'm'\ncommand = ['sh', '-c', 'test \"$2\" = square-DB-0.25-0 && test "
      "\"$1\" = \"$PWD/mesh.msh\" && test \"$3\" = \"$PWD\" && echo 1', 'sh', '{mesh}', "
      "'{case}-{pipeline}-{size}-{seed}', '{folder}']\n",
      "[\"DB\"]"));
  EXPECT_EQ(record("DB")["metrics"]["m"], 1) << record("DB")["failed_metrics"];
}

}  // namespace
}  // namespace delquad
