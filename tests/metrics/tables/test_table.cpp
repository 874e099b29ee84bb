// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrics/tables/table.h"
#include "tests/support/files.h"

namespace delquad {
namespace {

Table example() {
  Table table;
  table.title = "Title";
  table.columns = {{"eta_mean", "eta mean", 3}, {"d4", "d4", 1}};
  table.rows = {{"case_1", "DB", {{"eta_mean", 0.875}, {"d4", 88.25}}, {{"eta_mean", 0.75}}, "Table I", ""},
                {"case_1", "FB", {{"eta_mean", 0.5}, {"d4", std::nan("")}}, {}, "", ""},
                {"case|2", "DB", {}, {}, "", "size, \"x\", is < 0"}};
  table.notes = {"a note"};
  return table;
}

TEST(Tables, MarkdownShowsPublishedAndDifference) {
  const std::string text = to_markdown(example());
  EXPECT_TRUE(holds(text, "| 0.875 (0.75, +0.125) |", "88.3 |", " - |", "case\\|2", " failed |",
                    "- case|2 DB failed: size, \"x\", is < 0\n", "- a note\n"));
}

TEST(Tables, CsvQuotesAndKeepsDigits) {
  EXPECT_EQ(to_csv(example()),
            "case,pipeline,status,source,eta_mean,eta_mean_half_width,eta_mean_published,eta_mean_difference,"
            "d4,d4_half_width,d4_published,d4_difference\n"
            "case_1,DB,ok,Table I,0.875,,0.75,0.125,88.25,,,\n"
            "case_1,FB,ok,,0.5,,,,,,,\n"
            "case|2,DB,\"failed: size, \"\"x\"\", is < 0\",,,,,,,,,\n");
}

TEST(Tables, TexIsEscapedBooktabs) {
  Table table = example();
  table.columns[1].title = "d_4 %";
  const std::string text = to_tex(table);
  EXPECT_TRUE(holds(text,
                    "\\begin{longtable}[l]{@{}lrr@{}}\n\\toprule\npipeline & eta mean & d\\_4 \\% "
                    "\\tabularnewline\n\\midrule\n\\endhead\n\\bottomrule\n\\endfoot\n",
                    "\\multicolumn{3}{@{}l@{}}{\\emph{case\\_1}} \\tabularnewline\n"
                    "DB & 0.875 (0.75, +0.125) & 88.3 \\tabularnewline\n",
                    "\\end{longtable}"));
}

/// Everything that a reader of the paper has to know stands in the paper, not in comments.
TEST(Tables, TexSaysWhatFailed) {
  const std::string text = to_tex(example());
  EXPECT_TRUE(holds(text, "case$|$2}} \\tabularnewline\nDB & failed &  \\tabularnewline\n"));
  const auto notes = text.substr(text.find("\\end{longtable}"));
  EXPECT_TRUE(holds(notes, "is $<$", "Table", "note", "In brackets"));
  EXPECT_FALSE(holds(notes, "\n%"));
}

TEST(Tables, ColumnsCanBeChosenAndOrdered) {
  Table table = example();
  table.shown = {"d4", "eta_mean"};
  EXPECT_TRUE(holds(to_markdown(table), "| case    | pipeline |     d4 |             eta mean |"));
  EXPECT_TRUE(holds(to_tex(table), "pipeline & d4 & eta mean \\tabularnewline"));
  table.shown = {"d4"};
  EXPECT_FALSE(holds(to_markdown(table), "eta mean"));
  EXPECT_EQ(to_csv(table), to_csv(example())) << "has all";
  EXPECT_TRUE(holds(to_json(table), "\"eta_mean\": 0.875"));
}

TEST(Tables, WideOnesAreBrokenIntoTabularsOverTheSameRows) {
  Table table = example();
  for (int k = 0; k < 20; ++k)
    table.columns.push_back({"c" + std::to_string(k), "column " + std::to_string(k), 3});
  const std::string text = to_tex(table);
  std::size_t tabulars = 0, rows = 0, failed = 0;
  for (std::size_t at = 0; (at = text.find("\\begin{longtable}", at)) != text.npos; ++at) ++tabulars;
  for (std::size_t at = 0; (at = text.find("case\\_1}} \\tabularnewline\nDB", at)) != text.npos; ++at) ++rows;
  for (std::size_t at = 0; (at = text.find("& failed", at)) != text.npos; ++at) ++failed;
  EXPECT_GT(tabulars, 2u) << text;
  EXPECT_EQ(rows, tabulars);
  EXPECT_EQ(failed, tabulars);
  for (int k = 0; k < 20; ++k) EXPECT_TRUE(holds(text, "column " + std::to_string(k) + " ")) << k;
}

/// A journal's page takes them: no longtable, groups in lines of their own, nothing wider than the page.
TEST(Tables, FloatsHaveGroupsAndGoOn) {
  Table table = example();
  table.rows.erase(table.rows.begin() + 2);
  for (int k = 0; k < 40; ++k) {
    table.rows.push_back(table.rows[0]);
    table.rows.back().group = "pair " + std::to_string(k / 4);
  }
  table.columns.push_back({"words", "a text", 0});
  table.rows[0].texts["words"] =
      "one_two three four five six seven eight nine ten eleven twelve thirteen fourteen";
  const std::string text = to_tex_floats(table, "tab:x", "Of it");
  EXPECT_TRUE(text.starts_with("\\begin{table*}[tbp]\n\\caption{")) << text;
  EXPECT_TRUE(holds(
      text, ". Of it}\\label{tab:x}\n", ", continued.}\n",
      "\\multicolumn{4}{@{}l@{}}{\\emph{case\\_1}} \\tabularnewline\nDB & 0.875 (0.75, +0.125) & 88.3 & ",
      "\\raggedright one\\_two three"));
  EXPECT_FALSE(holds(text, "longtable"));
  std::size_t rows = 0;
  for (std::size_t at = 0; (at = text.find("\nDB & ", at)) != text.npos; ++at) ++rows;
  EXPECT_EQ(rows, 41u);
}

TEST(Tables, WordsOfNotesAreNotBrokenInTex) {
  Table table = example();
  table.notes = {"Wilcoxon's signed-rank test over administratively-named (see `a_b`) seeds.",
                 "/home/of/somebody/with/a_long/path/to/the/model.step is missing"};
  const std::string text = to_tex(table);
  EXPECT_TRUE(holds(text, "Wilcoxon's signed-rank test over administratively-named (see `a\\_b`) seeds.",
                    "/\\allowbreak{}home/\\allowbreak{}of/\\allowbreak{}somebody/", " is missing"));
}

TEST(Tables, JsonHoldsValuesAndReasons) {
  const std::string text = to_json(example());
  EXPECT_TRUE(holds(text, "\"difference\": {", "\"d4\": null", "\"reason\": \"size, \\\"x\\\", is < 0\""));
}

TEST(Tables, ProofsAndSpreadsAreShown) {
  Table table = example();
  table.rows[0].half_widths["d4"] = 1.25;
  table.rows[0].bold = {"d4"};
  const std::string markdown = to_markdown(table), tex = to_tex(table), json = to_json(table);
  EXPECT_TRUE(holds(markdown, "**88.3** ± 1.3 |"));
  EXPECT_TRUE(holds(tex, "\\textbf{88.3} $\\pm$ 1.3"));
  EXPECT_TRUE(holds(to_csv(table), "88.25,1.25,,"));
  EXPECT_TRUE(holds(json, "\"bold\": [\n        \"d4\"\n      ]",
                    "\"half_widths\": {\n        \"d4\": 1.25\n      }"));
}

TEST(Tables, RoundingHidesNoInterval) {
  Table table = example();
  table.columns.push_back({"d_max", "dmax", 0});
  table.rows[0].values["d_max"] = 5.375;
  table.rows[0].half_widths["d_max"] = 0.43;
  EXPECT_TRUE(holds(to_markdown(table), "5.38 ± 0.43"));
  EXPECT_TRUE(holds(to_tex(table), "5.38 $\\pm$ 0.43"));
}

TEST(Tables, IntervalsEndWhereTheMeasureDoes) {
  Table table = example();
  table.columns[0].range = {0, 1};
  table.columns[1].range = {0, 100};
  table.rows[0].half_widths = {{"eta_mean", 0.25}, {"d4", 1.25}};
  table.rows[1].half_widths = {{"eta_mean", 1e-16}};
  table.rows[1].values["eta_mean"] = 1;
  const std::string text = to_markdown(table);
  EXPECT_TRUE(holds(text, "0.88 [0.63, 1.00]", "88.3 ± 1.3", "1.000 ± < 0.001"));
  EXPECT_TRUE(holds(to_csv(table), "0.875,0.25,")) << "has the half-width";
}

}  // namespace
}  // namespace delquad
