#include <gtest/gtest.h>

#include <cmath>

#include "sweep/table.h"

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

bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(Tables, MarkdownShowsPublishedAndDifference) {
  const std::string text = to_markdown(example());
  EXPECT_TRUE(holds(text, "| 0.875 (0.75, +0.125) |")) << text;
  EXPECT_TRUE(holds(text, "88.2 |")) << text;
  EXPECT_TRUE(holds(text, " - |")) << text;
  EXPECT_TRUE(holds(text, "case\\|2")) << text;
  EXPECT_TRUE(holds(text, " failed |")) << text;
  EXPECT_TRUE(holds(text, "- case|2 DB failed: size, \"x\", is < 0\n")) << text;
  EXPECT_TRUE(holds(text, "- a note\n")) << text;
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
  EXPECT_TRUE(holds(
      text, "\\begin{tabular}{llrr}\n\\toprule\ncase & pipeline & eta mean & d\\_4 \\% \\\\\n\\midrule\n"))
      << text;
  EXPECT_TRUE(holds(text, "case\\_1 & DB & 0.875 (0.75, +0.125) & 88.2 \\\\\n")) << text;
  EXPECT_TRUE(text.find("\\bottomrule\n\\end{tabular}\n") != std::string::npos) << text;
}

TEST(Tables, JsonHoldsValuesAndReasons) {
  const std::string text = to_json(example());
  EXPECT_TRUE(holds(text, "\"difference\": {")) << text;
  EXPECT_TRUE(holds(text, "\"d4\": null")) << text;
  EXPECT_TRUE(holds(text, "\"reason\": \"size, \\\"x\\\", is < 0\"")) << text;
}

TEST(Tables, MarksAndSpreadsAreShown) {
  Table table = example();
  table.rows[0].half_widths["d4"] = 1.25;
  table.rows[0].marks["d4"] = Mark::kBest;
  table.rows[1].marks["eta_mean"] = Mark::kAsGoodAsBest;
  const std::string markdown = to_markdown(table), tex = to_tex(table);
  EXPECT_TRUE(holds(markdown, "**88.2** ± 1.2 |")) << markdown;
  EXPECT_TRUE(holds(markdown, "~0.500 |")) << markdown;
  EXPECT_TRUE(holds(tex, "\\textbf{88.2} $\\pm$ 1.2")) << tex;
  EXPECT_TRUE(holds(tex, "$\\sim$0.500")) << tex;
  EXPECT_TRUE(holds(to_csv(table), "88.25,1.25,,")) << to_csv(table);
}

}  // namespace
}  // namespace delquad
