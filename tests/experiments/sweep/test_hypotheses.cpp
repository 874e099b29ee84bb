// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/sweep/run_experiment.h"
#include "metrics/tables/study_file.h"
#include "tests/support/files.h"

namespace delquad {
namespace {

const std::string kHead =
    "pipelines = ['F', 'DB', 'DBC']\nsolver = ['poisson']\n[matrix]\ncross = ['boundary', 'x']\n"
    "seed = [1]\n";
/// Squares of different proportions, and the last one as the first, but larger.
const std::string kRectangles = [] {
  std::string text;
  for (int i = 1; i <= 5; ++i)
    text += "[[case]]\nname = \"r" + std::to_string(i) +
            "\"\nsize = 0.4\nloop = { rectangle = [[0, 0], [1, " + std::to_string(i) + "]] }\n";
  return text + "[[case]]\nname = 'large'\nsize = 0.9\nloop = { rectangle = [[1, 1], [3, 3]] }\n";
}();

class Planned : public testing::Test {
 protected:
  Experiment read(const std::string& text) { return Experiment::read(write_text(folder_ / "e.toml", text)); }
  std::string claim(const std::string& keys) { return kHead + "[[hypotheses]]\n" + keys + kRectangles; }
  std::string plan(const std::string& keys) { return dry_run(read(claim(keys)), ""); }
  static void expect_part(const std::string& text, const std::string& part) {
    EXPECT_TRUE(holds(text, part)) << part << "\nis not in\n" << text;
  }

  Folder folder_;
};

TEST_F(Planned, HypothesesMayBeOnValues) {
  EXPECT_EQ(read("[matrix]\nregularity.tolerance = [0.1, 0.05]\n[[hypotheses]]\nalong = "
                 "\"tolerance\"\nbetter = 0.05\n"
                 "than = 0.1\nmeasures = [\"d4\"]\n" +
                 kRectangles)
                .hypotheses.at(0),
            (Hypothesis{"tolerance", "0.05", "0.1", {"d4"}}));
}

TEST_F(Planned, ADryRunSaysWhatCanBeProven) {
  const std::string keys = "better = 'DBC'\nthan = 'DB'\nmeasures = ['eta_mean']\n";
  const std::string five = plan(keys);
  expect_part(five, "to do          r1@cross=boundary,seed=1 F\n");
  expect_part(five, "cells: 36, of which 0 are done\ntime: not known");
  expect_part(five, "domains (geometries): 5\n  one domain: r1, large\n");
  expect_part(five,
              "tests of hypotheses: 1\n  1 over 5 domains: nothing can be proven; it takes 6 domains\n");
  // Six have 2 * 2^-6.
  const std::string sixth = "[[case]]\nname = 'r6'\nsize = 0.4\nloop = { rectangle = [[0, 0], [1, 6]] }\n";
  expect_part(dry_run(read(claim(keys) + sixth), ""),
              "  1 over 6 domains: p corrected 0.0312 at the least\n");
  // Seven: 7 * 2 * 2^-n is at most 0.05 from nine on.
  std::string many = keys;
  many.replace(
      many.find("'eta_mean'"), 10,
      "\"eta_mean\", \"eta_worst\", \"d4\", \"tau\", \"aspect_max\", \"poisson_h1\", \"poisson_l2\"");
  expect_part(plan(many), "  7 over 5 domains: nothing can be proven; it takes 9 domains\n");
  // Without hypotheses DB and DBC are one pair, in eta mean, eta worst, d4, tau and four measures of the
  // solver.
  expect_part(
      dry_run(read(kHead + kRectangles), ""),
      "tests: at most 8, of which 0 could prove something\n  8 over 5 domains: nothing can be proven");
}

/// The first command of docs/experiments.md.
TEST_F(Planned, ADryRunNeedsNoResultsInTheFolder) {
  const std::string experiment = claim("better = 'DBC'\nthan = 'DB'\nmeasures = ['eta_mean']\n");
  expect_part(dry_run(read(experiment), folder_ / "results"), "cells: 36, of which 0 are done\n");
  EXPECT_FALSE(fs::exists(folder_ / "results"));
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
  expect_part(dry_run(read(text("d4")), out), "cells: 2, of which 2 are done\ntime: about 0 s");
  Experiment other = read(text("d4"));
  other.file = "other.toml";
  const std::string refused = dry_run(other, out);
  expect_part(refused, "not of 'other': give another folder\ncells: 2, of which 0 are done\n");
  EXPECT_FALSE(holds(refused, "guessed")) << "the same case";
  EXPECT_EQ(read_study(out)->hypotheses, read(text("d4")).hypotheses);
  EXPECT_TRUE(note_after(text("tau")));
  EXPECT_TRUE(note_after(text("d4"))) << "it stays said";
  expect_part(dry_run(read(text("d4")), out), "warning: Not planned");
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
  fs::remove_all(out);
  EXPECT_FALSE(note_after(text("tau")));
  std::string seeded = text("tau");
  EXPECT_TRUE(note_after(seeded.replace(seeded.find("size = 0.5"), 0, "seed = 2\n"))) << "another seed";
  EXPECT_TRUE(holds(read_text(out / "hypotheses.md"), "exploratory"));
}

/// Whatever a case says belongs to the plan: seeds, sizes and models could be tried until something is
/// proven.
TEST_F(Planned, NothingOfCasesCanBeTried) {
  const std::string head =
      "pipelines = ['DB', 'DBC']\n[[hypotheses]]\nbetter = 'DBC'\nthan = 'DB'\nmeasures = ['d4']\n";
  const std::string first = "[[case]]\nname = 'a'\nseed = 1\nsize = 0.5\nmodel = 'a.toml'\n";
  const std::string second = "[[case]]\nname = 'b'\nsize = 0.5\nloop = { rectangle = [[0, 0], [1, 2]] }\n";
  const auto model = [&](double width) {
    write_text(folder_ / "a.toml", "loop = { rectangle = [[0, 0], [" + std::to_string(width) + ", 1]] }\n");
  };
  model(1);
  const auto plan_of = [&](const std::string& text) { return describe(read(text)).plan; };
  const auto with = [](std::string text, const std::string& from, const std::string& to) {
    return text.replace(text.find(from), from.size(), to);
  };
  const std::string before = plan_of(head + first + second);
  EXPECT_EQ(plan_of(head + second + first), before) << "the order of cases";
  EXPECT_EQ(plan_of("title = \"x\"\ncolumns = [\"d4\"]\n# y\n" + head + first + second), before);
  EXPECT_EQ(plan_of(head + with(first, "0.5", "5e-1") + second), before) << "the same number";
  for (const std::string& other :
       {with(first, "seed = 1", "seed = 2"), with(first, "size = 0.5", "size = 0.4"),
        first + "regularity = { rounds = 1 }\n", first + "domain = 'b'\n"})
    EXPECT_NE(plan_of(head + other + second), before) << other;
  EXPECT_NE(plan_of(with(head, "'DBC']", "'DBC', 'FB']") + first + second), before) << "a pipeline more";
  const std::string peer =
      "[[peer]]\nname = 'x'\ncommand = ['x', '{input}', '{output}']\nversion = ['true']\n";
  const std::string with_peer = plan_of(head + peer + first + second);
  for (const std::string keys : {"exit_codes = [1]\n", "metrics = true\n", "surfaces = 'none'\n"})
    EXPECT_NE(plan_of(head + peer + keys + first + second), with_peer) << keys;
  EXPECT_NE(plan_of("solver = [\"poisson\"]\n" + head + first + second), before);
  EXPECT_NE(plan_of(head + first + second + "[[variant]]\nname = \"v\"\norder = 2\n"), before);
  model(1.5);
  EXPECT_NE(plan_of(head + first + second), before) << "another model in the same file";
}

/// Headers of STEP and sizes of an outline that was exported make no domains.
TEST_F(Planned, DomainsAreGeometries) {
  std::string text = "pipelines = ['DB']\n";
  const auto add = [&](const std::string& name, const std::string& model) {
    text += "[[case]]\nname = \"" + name + "\"\nsize = 1\nmodel = \"" + model + "\"\n";
  };
  for (const std::string name : {"s1", "s2", "s3"}) {
    write_text(folder_ / (name + ".step"),
               "ISO-10303-21;\nHEADER;\nFILE_NAME('" + name + "');\nENDSEC;\nDATA;\n#1=" +
                   (name == "s3" ? "OTHER" : "POINT") + "();\nENDSEC;\nEND-ISO-10303-21;\n");
    add(name, name + ".step");
  }
  // A polygon by lines, each of `n` edges, turned and scaled; the last one is another.
  for (const int n : {1, 2, 5, 6}) {
    Mesh mesh;
    const std::vector<Vec2> corners = {{0, 0}, {3, 0}, {3, n == 6 ? 1.5 : 1.0}, {1, 1}, {1, 2}, {0, 2}};
    for (std::size_t k = 0; k < corners.size(); ++k)
      for (int i = 0; i < n; ++i) {
        const Vec2 u = corners[k] + i / double(n) * (corners[(k + 1) % corners.size()] - corners[k]);
        const double c = n * std::cos(n), s = n * std::sin(n);
        mesh.points.push_back({c * u.x - s * u.y + n, s * u.x + c * u.y, 0});
        const int here = static_cast<int>(mesh.points.size()) - 1;
        mesh.lines.push_back({here, (here + 1) % (n * 6)});
      }
    mesh.line_curve.assign(mesh.lines.size(), 0);
    mesh.curves = {{1, {"rim"}}};
    const std::string name = "p" + std::to_string(n);
    write_mesh(folder_ / (name + ".msh"), mesh);
    add(name, name + ".msh");
  }
  const std::map<std::string, std::string> expected = {{"s1", "s1"}, {"s2", "s1"}, {"s3", "s3"}, {"p1", "p1"},
                                                       {"p2", "p1"}, {"p5", "p1"}, {"p6", "p6"}};
  EXPECT_EQ(domains_of(describe(read(text))), expected);
}

/// The key `domain` counts as it stands now, and belongs to the plan.
TEST_F(Planned, DomainsOfTheExperimentCountForOldRecords) {
  const auto text = [](const std::string& domain) {
    std::string cases = "pipelines = ['DB']\n";
    for (const std::string n : {"1", "2"})
      cases += "[[case]]\nname = \"r" + n + "\"\nsize = 0.5\nloop = { rectangle = [[0, 0], [1, " + n +
               "]] }\n" + domain;
    return cases;
  };
  const fs::path out = folder_ / "out";
  run_experiment(read(text("")), out);
  const auto domain_of_second = [&] { return read_results(out).records.at(1).domain; };
  EXPECT_EQ(domain_of_second(), "r2");
  run_experiment(read(text("domain = 'same'\n")), out);
  EXPECT_EQ(domain_of_second(), "same");
  expect_part(read_text(out / "runs.csv"), "r2,same,");
}

}  // namespace
}  // namespace delquad
