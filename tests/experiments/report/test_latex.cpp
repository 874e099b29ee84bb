// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrics/tables/tables.h"
#include "tests/experiments/report/report_results.h"
#include "tests/support/files.h"

namespace delquad::testing_support {
namespace {

bool has_latex() {
  return std::system("kpsewhich booktabs.sty >/dev/null 2>&1 && command -v pdflatex >/dev/null") == 0;
}

/// Where LaTeX finds nothing to complain of, and nothing sticks out of the page, "" and a PDF; else what it
/// said.
std::string compile(const fs::path& folder, const std::string& name) {
  const ProgramResult result = run_program(
      "/bin/sh",
      {{"-c", "cd '" + folder.string() + "' && pdflatex -interaction=nonstopmode -halt-on-error " + name},
       0,
       {}});
  const bool whole = result.exit_code == 0 && fs::exists(folder / (fs::path(name).stem().string() + ".pdf"));
  return whole && result.out.find("Overfull") == std::string::npos ? "" : "said: " + result.out;
}

/// The results of the study, and the paper about it.
class StudyPrograms : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<Folder>();
    for (const char* file : {"study.toml", "paper.tex"})
      fs::copy_file(fs::path(DELQUAD_EXAMPLES) / "study" / file, *folder_ / file);
    ASSERT_EQ(delquad({"run", *folder_ / "study.toml", "-o", results(), "--pictures", "none"}).exit_code, 0);
  }
  static void TearDownTestSuite() { folder_.reset(); }
  static fs::path results() { return *folder_ / "results"; }

  static ProgramResult check_claims() {
    return run_program("/usr/bin/python3", {{DELQUAD_EXPERIMENTS "/check_claims.py", results()}, 0, {}});
  }

  static inline std::unique_ptr<Folder> folder_;
};

TEST_F(StudyPrograms, IsAPaperWithProvenClaims) {
  if (!has_latex()) GTEST_SKIP() << "pdflatex and booktabs are not installed";
  if (std::system("/usr/bin/python3 -c 'import matplotlib' 2>/dev/null") != 0)
    GTEST_SKIP() << "python3-matplotlib is not installed";
  EXPECT_EQ(compile(folder_->path(), "paper.tex"), "");
  const std::string tables = read_text(results() / "tables.tex");
  EXPECT_TRUE(holds(tables, "\\textbf{")) << "something is proven";
  EXPECT_FALSE(holds(tables, "longtable"));
  if (std::system("command -v pdffonts >/dev/null") != 0) GTEST_SKIP() << "poppler-utils is not installed";
  const ProgramResult fonts =
      run_program("/bin/sh", {{"-c", "pdffonts '" + (*folder_ / "paper.pdf").string() + "'"}, 0, {}});
  EXPECT_TRUE(holds(fonts.out, "DejaVuSans"));
  EXPECT_FALSE(holds(fonts.out, " no  yes")) << "a font that is not inside: " << fonts.out;
}

TEST_F(StudyPrograms, ClaimsAreConfirmedByAnotherProgram) {
  if (std::system("/usr/bin/python3 -c 'import scipy' 2>/dev/null") != 0)
    GTEST_SKIP() << "python3-scipy is not installed";
  const ProgramResult whole = check_claims();
  EXPECT_EQ(whole.exit_code, 0) << whole.out << whole.err;
  EXPECT_TRUE(holds(whole.out, "4 comparisons of 4 tests"));
  const auto tamper = [](const char* file, const std::string& claim, const std::string& by) {
    std::string text = read_text(results() / file);
    const auto at = text.find(claim);
    ASSERT_NE(at, std::string::npos) << text;
    write_text(results() / file, text.replace(at, claim.size(), by));
  };
  const auto expect_refused = [](const std::string& reason) {
    const ProgramResult tampered = check_claims();
    EXPECT_EQ(tampered.exit_code, 1);
    EXPECT_TRUE(holds(tampered.out, reason));
  };
  tamper("hypotheses.csv", ",proven,", ",refuted,");
  expect_refused("is 'refuted', by runs.csv 'proven'");
  tamper("study.json", "\"plan_changed\": false", "\"plan_changed\": true");
  ASSERT_EQ(delquad({"tables", results()}).exit_code, 0);
  EXPECT_TRUE(holds(check_claims().out, "tests: not planned, confirmed"));
  tamper("pairs.csv", ",exploratory,", ",better,");
  expect_refused("claims what was not planned");
  // The same meshes without hypotheses: every two words are tested.
  std::string study = read_text(*folder_ / "study.toml");
  const auto first = study.find("[[hypotheses]]");
  write_text(*folder_ / "study.toml", study.erase(first, study.find("[matrix]") - first));
  fs::remove_all(results());
  ASSERT_EQ(delquad({"run", *folder_ / "study.toml", "-o", results(), "--pictures", "none"}).exit_code, 0);
  const ProgramResult pairs = check_claims();
  EXPECT_EQ(pairs.exit_code, 0) << pairs.out << pairs.err;
  EXPECT_TRUE(holds(pairs.out, "24 comparisons"));
  tamper("pairs.csv", ",not proven,", ",better,");
  expect_refused("is 'better', by runs.csv 'not proven'");
  fs::remove(results() / "pairs.csv");
  expect_refused("0 comparisons of ");
}

/// Every tabular is measured by LaTeX itself, at 8 points. These are the widest that tables of ours become by
/// default, with half-widths, marks, published numbers and long names.
TEST(LatexPrograms, DefaultColumnsFitAPage) {
  if (!has_latex()) GTEST_SKIP() << "pdflatex and booktabs are not installed";
  const Folder folder;
  StudyResults results;
  results.study.title = "Wide";
  results.study.pipelines = {"DB", "DLBCO", "gmsh-frontal-quads-full"};
  results.study.published = {{"Theirs", "Table 9 of a paper", {{"eta_mean", 0.8765}, {"n_quads", 123456}}}};
  for (const std::string name :
       {"plate_16_holes", "a_case_whose_name_is_as_long_as_names_of_cases_may_be_and_more"}) {
    results.study.cases.push_back(name);
    results.study.compare[name] = {{"DB", "Theirs"}};
    for (int seed = 0; seed < 12; ++seed)
      for (std::size_t w = 0; w < results.study.pipelines.size(); ++w) {
        CellRecord record{name + "@" + std::to_string(seed), results.study.pipelines[w], "", {}};
        record.name = name;
        record.variant = {{"h_max", "1.4"}, {"seed", std::to_string(seed)}};
        record.values = {
            {"n_quads", 123456 + 1000 * seed}, {"n_vertices", 123456 + seed}, {"n_triangles", 0.0}};
        for (const char* key :
             {"eta_worst", "eta_mean", "d4", "tau", "d_min", "d_max", "percent_quads", "seconds"})
          record.values[key] = 10.0 * static_cast<double>(w) + 0.01 * seed;
        results.records.push_back(record);
      }
  }
  results.records[0].reason = "näive \xF0\x9F\x98\x80 reasons: \"<x>\" | \\ and 100 % of __init__";
  const Outcome outcome = make_tables(results);
  write_text(folder / "table.tex", to_tex(outcome.table));
  write_text(folder / "pairs.tex", to_tex(outcome.pairs));
  write_text(folder / "tables.tex", outcome.files.at("tables.tex"));
  write_text(
      folder / "t.tex",
      "\\documentclass[a4paper]{article}\\usepackage{booktabs,longtable}\\hfuzz=0.1pt\\begin{document}\n"
      "\\input{tables}\n\\input{table}\n\\input{pairs}\n"
      "\\footnotesize\\typeout{size \\csname f@size\\endcsname}\\end{document}\n");
  EXPECT_EQ(compile(folder.path(), "t.tex"), "");
  EXPECT_TRUE(holds(read_text(folder / "t.log"), "size 8"));
  EXPECT_FALSE(holds(to_tex(outcome.table), "scriptsize"));
}

/// One word with two options on ten domains; the second value of each is better on all of them.
StudyResults study_of_options() {
  StudyResults results;
  results.study.title = "Options";
  results.study.pipelines = {"DBO"};
  results.study.axes = {{"passes", {"1", "2"}}, {"a_cost_with_a_long_name", {"angle", "eta"}}};
  results.study.pairs = {"passes", "a_cost_with_a_long_name"};
  for (int domain = 0; domain < 10; ++domain) {
    results.study.cases.push_back("domain_" + std::to_string(domain));
    for (const int passes : {1, 2})
      for (const bool eta : {false, true}) {
        CellRecord record{results.study.cases.back() + "@" + std::to_string(2 * passes + eta), "DBO", "", {}};
        record.name = record.domain = results.study.cases.back();
        record.variant = {{"passes", std::to_string(passes)},
                          {"a_cost_with_a_long_name", eta ? "eta" : "angle"}};
        record.values = {{"n_quads", 1000}, {"n_triangles", 0}};
        for (const char* key : {"eta_worst", "eta_mean", "d4", "tau"})
          record.values[key] = 0.123456 + 0.1 * passes + 0.05 * eta + 0.01 * domain * passes;
        results.records.push_back(record);
      }
  }
  return results;
}

TEST(Latex, OptionsHaveARowForEachValue) {
  const Outcome outcome = make_tables(study_of_options());
  const std::vector<TableRow>& rows = outcome.summary.rows;
  ASSERT_EQ(rows.size(), 16u) << "four values in four measures";
  EXPECT_EQ(rows[1].name, "passes=2");
  EXPECT_EQ(rows[1].values.at("won"), 10);
  for (std::size_t i = 1; i < rows.size(); i += 4)
    EXPECT_TRUE(rows[i].bold.contains("mean")) << "better than all others of its axis: " << rows[i].group;
  const std::string tables = outcome.files.at("tables.tex");
  EXPECT_TRUE(holds(tables, "than every other of its axis"));
  EXPECT_EQ(tables.find("p{", tables.find("tab:pairs")), std::string::npos) << tables;
}

StudyResults planned_study() {
  StudyResults results = study_of_options();
  results.study.hypotheses = {{"passes", "2", "1", {"eta_mean", "d4"}},
                              {"a_cost_with_a_long_name", "eta", "angle", {"tau"}}};
  return results;
}

TEST(Latex, PlannedStudiesSayHowTheyAreTested) {
  StudyResults results = planned_study();
  const Outcome planned = make_tables(results);
  const std::string tables = planned.files.at("tables.tex");
  EXPECT_TRUE(holds(tables, "two-sided", "over all hypotheses", "p corr.", "\\textbf{", "as hypotheses ask"));
  const std::string alone = to_tex(planned.hypotheses);
  EXPECT_FALSE(holds(alone, "p{")) << "long names stand above their rows: " << alone;
  results.study.plan_changed = true;
  const Outcome late = make_tables(results);
  const std::string marked = late.files.at("tables.tex");
  EXPECT_TRUE(holds(marked, "\\textbf{Not planned: "));
  EXPECT_FALSE(holds(marked, "\\textbf{0"));
  EXPECT_FALSE(holds(marked, "Bold"));
}

/// No box is too wide or too loose.
std::string compile_inputs(const Outcome& outcome, const std::string& names) {
  const Folder folder;
  write_text(folder / "tables.tex", outcome.files.at("tables.tex"));
  write_text(folder / "summary.tex", to_tex(outcome.summary));
  write_text(folder / "pairs.tex", to_tex(outcome.pairs));
  write_text(folder / "hypotheses.tex", to_tex(outcome.hypotheses));
  write_text(folder / "t.tex",
             "\\documentclass[a4paper]{article}\\usepackage{booktabs,longtable}\\begin{document}\n" + names +
                 "\\end{document}\n");
  const std::string said = compile(folder.path(), "t.tex");
  const std::string log = read_text(folder / "t.log");
  return said + (log.find("Underfull \\hbox") == log.npos ? "" : log);
}

TEST(LatexPrograms, StudiesOfOptionsAreSet) {
  if (!has_latex()) GTEST_SKIP() << "pdflatex and booktabs are not installed";
  EXPECT_EQ(
      compile_inputs(make_tables(study_of_options()), "\\input{tables}\n\\input{summary}\n\\input{pairs}\n"),
      "");
  EXPECT_EQ(compile_inputs(make_tables(planned_study()),
                           "\\input{tables}\n\\input{summary}\n\\input{hypotheses}\n"),
            "");
}

TEST(LatexPrograms, LongTablesBreakOverPages) {
  if (!has_latex()) GTEST_SKIP() << "pdflatex and booktabs are not installed";
  const Folder folder;
  Table table;
  table.title = "Long";
  table.columns = {{"eta_mean", "eta mean", 3}, {"d4", "d4", 1}};
  for (int k = 0; k < 120; ++k)
    table.rows.push_back(
        {"case_" + std::to_string(k / 3), "DB", {{"eta_mean", 0.5}, {"d4", 80}}, {}, "", ""});
  table.notes = {
      "/home/of/somebody/with/a_long/path/that/goes/on/and/on/for_more/than/a/line/of/text/is/wide/to/the/"
      "model.step is missing"};
  write_text(folder / "table.tex", to_tex(table));
  write_text(
      folder / "t.tex",
      "\\documentclass[a4paper]{article}\\usepackage{booktabs,longtable}\\begin{document}\nBefore it.\n\n"
      "\\input{table}\n\\end{document}\n");
  EXPECT_EQ(compile(folder.path(), "t.tex"), "");
  EXPECT_TRUE(holds(read_text(folder / "t.log"), "t.pdf (4 pages"))
      << "120 rows, and a line above each of 40 cases";
}

TEST(LatexPrograms, TextsThatMeanSomethingToIt) {
  if (!has_latex()) GTEST_SKIP() << "pdflatex and booktabs are not installed";
  const Folder folder;
  write_text(folder / "reference.toml",
             "source = \"50 % & #1 of {A}\"\n[[row]]\nname = \"a_b^c~d \\\\ $e$\"\neta_mean = 0.5\n");
  write_text(folder / "50%_&{}#$^~.msh", "no mesh");
  run_into(
      folder, "odd",
      "title = \"100 % & \\\\ten_x {\\n} ^2 ~ #3 $\"\nreference = \"reference.toml\"\npipelines = [\"DB\"]\n"
      "size = 0.5\n[[case]]\nname = \"a_b\"\nloop = { rectangle = [[0, 0], [1, 1]] }\n"
      "[[case]]\nname = \"broken\"\nmesh = \"50%_&{}#$^~.msh\"\n");
  write_text(folder / "t.tex",
             "\\documentclass{article}\\usepackage{booktabs,longtable}\\begin{document}\\input{results/odd/"
             "table}\\end{document}\n");
  EXPECT_EQ(compile(folder.path(), "t.tex"), "");
}

}  // namespace
}  // namespace delquad::testing_support
