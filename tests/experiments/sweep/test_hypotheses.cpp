#include <gtest/gtest.h>

#include "experiments/sweep/run_experiment.h"
#include "metrics/tables/study_file.h"
#include "tests/support/expect_input_error.h"
#include "tests/support/run_program.h"

namespace delquad {
namespace {

namespace fs = std::filesystem;
using testing_support::read_text;
using testing_support::write_text;

const std::string kHead =
    "pipelines = [\"F\", \"DB\", \"DBC\"]\nsolver = [\"poisson\"]\n[matrix]\ncross = [\"boundary\", \"x\"]\n"
    "seed = [1]\n";
/// Of different proportions, and the last one as the first, but larger.
const std::string kRectangles = [] {
  std::string text;
  for (int i = 1; i <= 5; ++i)
    text += "[[case]]\nname = \"r" + std::to_string(i) +
            "\"\nsize = 0.4\nloop = { rectangle = [[0, 0], [1, " + std::to_string(i) + "]] }\n";
  return text + "[[case]]\nname = \"large\"\nsize = 0.9\nloop = { rectangle = [[1, 1], [3, 3]] }\n";
}();

class Planned : public testing::Test {
 protected:
  Experiment read(const std::string& text) { return Experiment::read(write_text(folder_ / "e.toml", text)); }
  std::string claim(const std::string& keys) { return kHead + "[[hypotheses]]\n" + keys + kRectangles; }
  std::string plan(const std::string& keys, std::optional<double> effect = {}) {
    return dry_run(read(claim(keys)), "", effect);
  }
  void expect_refusal(const std::string& keys, std::initializer_list<const char*> parts) {
    expect_input_error([&] { plan(keys); }, parts);
  }
  static void expect_part(const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << part << "\nis not in\n" << text;
  }

  testing_support::TemporaryFolder folder_;
};

TEST_F(Planned, HypothesesAreRefusedBeforeTheRun) {
  const std::string good = "better = \"DBC\"\nthan = \"DB\"\nmeasures = [\"eta_mean\"]\n";
  EXPECT_NO_THROW(plan(good));
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string keys = good;
    return keys.replace(keys.find(from), from.size(), to);
  };
  expect_refusal(with("\"DBC\"", "\"DBCO\""), {"e.toml:7", "'DBCO' is none of the pipelines", "'DBC'"});
  expect_refusal(with("\"DBC\"", "\"DB\""), {"e.toml:8", "compared with itself"});
  expect_refusal(with("\"DBC\"", "\"F\""), {"e.toml:8", "no case of which 'F' and 'DB' have quads"});
  expect_refusal(with("eta_mean", "eta_men"), {"e.toml:9", "'eta_men'", "'eta_mean'"});
  expect_refusal(with("eta_mean", "n_vertices"), {"e.toml:9", "'n_vertices'", "neither more nor less"});
  expect_refusal(with("eta_mean", "seconds"), {"e.toml:9", "'repeat_times'"});
  expect_refusal(with("\"eta_mean\"", "\"d4\", \"d4\""), {"e.toml:9", "'d4'", "twice"});
  expect_refusal(good + "along = \"cros\"\n", {"e.toml:10", "'cros' does not vary", "'cross'"});
  expect_refusal(good + "along = \"seed\"\n", {"e.toml:10", "'seed' does not vary"});
  expect_refusal(good + "along = \"cross\"\n", {"e.toml:7", "'DBC' is no value of 'cross'", "'boundary'"});
  expect_refusal(good + "primary = true\n", {"e.toml:10", "unknown key"});
  expect_input_error([&] { read("pairs = [\"sise\"]\n" + kHead + kRectangles); }, {"e.toml:1", "'sise'"});
  EXPECT_EQ(
      read("[matrix]\ncleanup.tolerance = [0.1, 0.05]\n[[hypotheses]]\nalong = \"tolerance\"\nbetter = 0.05\n"
           "than = 0.1\nmeasures = [\"d4\"]\n" +
           kRectangles)
          .hypotheses.at(0),
      (Hypothesis{"tolerance", "0.05", "0.1", {"d4"}}));
}

TEST_F(Planned, ADryRunSaysWhatCanBeProven) {
  const std::string keys = "better = \"DBC\"\nthan = \"DB\"\nmeasures = [\"eta_mean\"]\n",
                    two = "two_sided = true\n";
  const std::string one = plan(keys, 0.5);
  expect_part(one, "to do          r1@cross=boundary,seed=1 F\n");
  expect_part(one, "cells: 36, of which 0 are done\ntime: not known");
  expect_part(one, "domains (geometries): 5\n  one domain: r1, large\n");
  expect_part(one, "tests of hypotheses: 1 primary, 0 secondary\n");
  // Of five: 2^-5. The power of five that all agree, P(Z > -.5)^5, by hand.
  expect_part(
      one, "  1 one-sided over 5 domains: p corrected 0.0312 at the least; power 0.16 for 0.5 deviations\n");
  expect_part(plan(keys + two), "  1 two-sided over 5 domains: nothing can be proven; it takes 6 domains\n");
  // Seven: 7 * 2^-n is at most .05 from eight on, 7 * 2^-n * 2 from nine on.
  const std::string seven =
      "\"eta_mean\", \"eta_worst\", \"d4\", \"tau\", \"aspect_max\", \"poisson_h1\", \"poisson_l2\"";
  std::string many = keys;
  many.replace(many.find("\"eta_mean\""), 10, seven);
  expect_part(plan(many), "  7 one-sided over 5 domains: nothing can be proven; it takes 8 domains\n");
  expect_part(plan(many + two), "  7 two-sided over 5 domains: nothing can be proven; it takes 9 domains\n");
  // Secondary ones wait for the primary one.
  const std::string second =
      "[[hypotheses]]\nalong = \"cross\"\nbetter = \"x\"\nthan = \"boundary\"\n"
      "measures = [\"tau\"]\nsecondary = true\n";
  expect_part(plan(keys + second), "  secondary, 1 one-sided over 5 domains: p corrected 0.0312");
  expect_part(plan(many + second),
              "  secondary, 1 one-sided over 5 domains: nothing can be proven; it takes 8 domains\n");
  // Without hypotheses DB and DBC are one pair, in eta mean, eta worst, d4, tau and four measures of the
  // solver.
  const std::string all = dry_run(read(kHead + kRectangles), "", {});
  expect_part(all,
              "could prove something; 8 are of pairs, over domains\n  8 two-sided over 5 domains: nothing "
              "can be proven");
}

TEST_F(Planned, ProgramNeedsNoFolderForADryRun) {
  const auto run = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"run", write_text(folder_ / "e.toml", kHead + kRectangles).string()});
    return testing_support::run_program(DELQUAD_PROGRAM, {std::move(more), 0, {}});
  };
  const auto dry = run({"--dry-run", "--effect", "0.5"});
  EXPECT_EQ(dry.exit_code, 0) << dry.err;
  expect_part(dry.out, "cells: 36");
  const auto wet = run({});
  EXPECT_EQ(wet.exit_code, 2);
  expect_part(wet.err, "--output is required");
  EXPECT_EQ(run({"-o", (folder_ / "out").string(), "--effect", "0.5"}).exit_code, 2) << "for --dry-run";
}

TEST_F(Planned, PlansThatWereChangedAfterwardsSaySo) {
  const auto text = [](const std::string& measure, const std::string& more = "") {
    return "pipelines = [\"DB\", \"DBC\"]\n[[hypotheses]]\nbetter = \"DBC\"\nthan = \"DB\"\nmeasures = [\"" +
           measure + "\"]\n[[case]]\nname = \"a\"\nsize = 0.5\nloop = { rectangle = [[0, 0], [1, 1]] }\n" +
           more;
  };
  const fs::path out = folder_ / "out";
  const auto note_after = [&](const std::string& experiment) {
    run_experiment(read(experiment), out);
    return read_text(out / "hypotheses.md").find("Not planned") != std::string::npos;
  };
  EXPECT_FALSE(note_after(text("d4")));
  EXPECT_FALSE(note_after(text("d4"))) << "again";
  expect_part(dry_run(read(text("d4")), out, {}), "cells: 2, of which 2 are done\ntime: about 0 s");
  Experiment other = read(text("d4"));
  other.file = "other.toml";
  const std::string refused = dry_run(other, out, {});
  expect_part(refused, "not of 'other': give another folder\ncells: 2, of which 0 are done\n");
  EXPECT_EQ(refused.find("guessed"), std::string::npos) << "the same case";
  EXPECT_EQ(read_study(out)->hypotheses, read(text("d4")).hypotheses);
  EXPECT_TRUE(note_after(text("tau")));
  EXPECT_TRUE(note_after(text("d4"))) << "it stays said";
  expect_part(dry_run(read(text("d4")), out, {}), "warning: Not planned");
  expect_part(read_text(out / "runs_columns.csv"), ",hypotheses\n");
  std::string without = text("d4");
  run_experiment(read(without.erase(without.find("[[hyp"), without.find("[[case") - without.find("[[hyp"))),
                 out);
  EXPECT_FALSE(fs::exists(out / "hypotheses.md")) << "nothing of an earlier run stays";
  fs::remove_all(out);
  EXPECT_FALSE(note_after(text("tau")));
  EXPECT_TRUE(note_after(
      text("tau", "[[case]]\nname = \"b\"\nsize = 0.5\nloop = { rectangle = [[0, 0], [1, 2]] }\n")))
      << "a case more";
}

}  // namespace
}  // namespace delquad
