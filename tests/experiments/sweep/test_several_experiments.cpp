#include <gtest/gtest.h>

#include <filesystem>
#include <regex>
#include <string>
#include <utility>
#include <vector>

#include "experiments/sweep/experiment.h"
#include "tests/support/expect_input_error.h"
#include "tests/support/run_program.h"

namespace delquad {
namespace {

namespace fs = std::filesystem;
using testing_support::ProgramResult;
using testing_support::read_text;
using testing_support::run_program;
using testing_support::write_text;

const std::string kGood =
    "[[case]]\nname = \"square\"\nsize = 0.5\nloop = { rectangle = [[0, 0], [1, 1]] }\n";
/// A disc has no mesh of squares, so that this is refused as unsound.
const std::string kBad =
    "[[case]]\nname = \"disc\"\nsize = 0.3\nloop = { circle = { centre = [0, 0], radius = 1 } }\n"
    "limits.min_angle = 89\n";
constexpr int kUnsound = 5;

class SeveralExperiments : public testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) const {
    return write_text(folder_ / name, "pipelines = [\"DB\"]\n" + text).string();
  }
  ProgramResult run(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), "run");
    arguments.insert(arguments.end(), {"-o", (folder_ / "out").string()});
    return run_program(DELQUAD_PROGRAM, {std::move(arguments), 0, {}});
  }
  /// The table without the spaces that align its columns.
  std::string table(const std::string& name) const {
    return std::regex_replace(read_text(folder_ / "out" / name / "table.md"), std::regex(" +"), " ");
  }

  testing_support::TemporaryFolder folder_;
};

void expect_in(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << "'" << part << "' is not in: " << text;
}

TEST_F(SeveralExperiments, DeclaredFailureIsNone) {
  const ProgramResult result =
      run({write("e.toml", "may_fail = [{ case = \"disc\", pipeline = \"DB\" }]\n" + kGood + kBad)});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err.find("error"), std::string::npos) << result.err;
  expect_in(result.err, "failed, as it may: disc DB: ");
  expect_in(table(""), "| disc | DB | 0 | failed |");
  expect_in(table(""), "case disc, pipeline DB: declared in `may_fail`; 1 of 1 cells failed");
  const ProgramResult undeclared = run({write("e.toml", kGood + kBad)});
  EXPECT_EQ(undeclared.exit_code, kUnsound);
  expect_in(undeclared.err, "error: disc DB failed: ");
}

TEST_F(SeveralExperiments, DeclaredVariantThatDoesNotFailIsNoted) {
  const ProgramResult result =
      run({write("e.toml", "may_fail = [{ variant = \"none\" }]\n" + kGood +
                               "[[variant]]\nname = \"all\"\n[[variant]]\nname = \"none\"\nseed = 2\n")});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  expect_in(table(""), "variant none: declared in `may_fail`; 0 of 1 cells failed");
}

TEST_F(SeveralExperiments, DeclarationsOfNothingAreRefused) {
  const auto refused = [&](const std::string& may_fail, std::initializer_list<const char*> parts) {
    expect_input_error([&] { Experiment::read(write("e.toml", "may_fail = [" + may_fail + "]\n" + kGood)); },
                       parts);
  };
  refused("{ case = \"squar\" }", {"e.toml:2: ", "no case 'squar'", "did you mean 'square'?"});
  refused("{ variant = \"x\" }", {"e.toml:2: ", "no variant 'x'"});
  refused("{ pipeline = \"DBC\" }", {"e.toml:2: ", "no pipeline 'DBC'"});
  refused("{ }", {"e.toml:2: ", "expected 'case', 'variant' or 'pipeline'"});
  refused("{ seed = 1 }", {"e.toml:2: ", "unknown key"});
}

/// As `make paper` runs them, with a page of all.
TEST_F(SeveralExperiments, AFailedCellIsNamedWhenAllElseIsDone) {
  if (!fs::exists("/usr/bin/make")) GTEST_SKIP() << "make is not installed";
  const std::string experiments = write("bad.toml", kGood + kBad) + " " + write("good.toml", kGood);
  const ProgramResult result = run_program(
      "/usr/bin/make",
      {{"-C", DELQUAD_SOURCE_DIR, "-o", "build", "-o", "fig15", "paper", "EXPERIMENTS=" + experiments,
        "DELQUAD=" DELQUAD_PROGRAM, "RESULTS=" + (folder_ / "out").string()},
       0,
       {}});
  EXPECT_EQ(result.exit_code, 2) << "make's own code";
  expect_in(result.err, "Error 5");
  const std::size_t named = result.err.find("error: bad/disc DB failed: ");
  EXPECT_NE(named, std::string::npos) << result.err;
  EXPECT_GT(named, result.err.find("2/2 good")) << result.err;
  expect_in(table("bad"), "| disc | DB | 0 | failed |");
  expect_in(table("good"), "| square | DB |");
  const std::string page = read_text(folder_ / "out/report.html");
  expect_in(page, "bad");
  expect_in(page, "good");
}

TEST_F(SeveralExperiments, TimeLeftIsWhatFilesSay) {
  const std::string a = write("a.toml", "minutes = 3\n" + kGood),
                    b = write("b.toml", "minutes = 4\n" + kGood);
  const ProgramResult dry = run({a, b, "--dry-run"});
  EXPECT_EQ(dry.exit_code, 0) << dry.err;
  for (const char* part : {"a.toml:\n", "b.toml:\n", "about 3 min on two cores", "about 4 min on two cores"})
    expect_in(dry.out, part);
  const ProgramResult first = run({a, b});
  EXPECT_EQ(first.exit_code, 0) << first.err;
  expect_in(first.err, "2 experiments: about 7 min on two cores\n1/2 a: about 3 min");
  expect_in(run({a, b}).err, "2 experiments: about 0 s");
}

TEST_F(SeveralExperiments, MistakesAreFoundBeforeAnyOfThemRuns) {
  fs::create_directories(folder_ / "other");
  const std::string good = write("a.toml", kGood);
  for (const std::string& second :
       {write("other/a.toml", kGood), write("b.toml", "titel = \"b\"\n" + kGood)}) {
    EXPECT_EQ(run({good, second}).exit_code, 2);
    EXPECT_FALSE(fs::exists(folder_ / "out"));
  }
}

}  // namespace
}  // namespace delquad
