#pragma once

#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <set>
#include <string>
#include <vector>

#include "metrics/tables/statistics.h"

namespace delquad {

struct TableColumn {
  std::string key;                         ///< in CSV and JSON
  std::string title;                       ///< for people
  int digits = 0;                          ///< after the decimal point
  Interval range = {-HUGE_VAL, HUGE_VAL};  ///< that no value leaves
};

struct TableRow {
  std::string group, name;                  ///< first two columns: case and pipeline
  std::map<std::string, double> values;     ///< by column key; absent or NaN: not known
  std::map<std::string, double> published;  ///< to compare with, as printed there
  std::string source;                       ///< where the published values stand; empty: none
  std::string failure;                      ///< why there are no values; empty: none
  std::string skipped = {};                 ///< why it was left out; empty: it was not
  /// Of means over several runs: half the width of their 95 % confidence interval, by column key.
  std::map<std::string, double> half_widths = {};
  std::set<std::string> bold = {};  ///< keys of columns: proven
  std::map<std::string, std::string> texts =
      {};                       ///< what stands for a value, by column key; absent: the number
  std::string unsound = {};     ///< how many of the meshes are not sound; empty: all are
  std::string incomplete = {};  ///< how many of the runs failed; empty: none, or all
};

/// Why a pipeline was left out that is not for the case: kind, as in ProcessFailure, and status of its
/// record.
inline constexpr const char* kNotApplicable = "not applicable";
/// The column that says of how many runs the values are.
inline constexpr const char* kRuns = "n";
/// What finish steps took.
inline constexpr const char* kFinishSeconds = "finish_seconds";

/// The second column, where it says so when meshes are not sound or runs have failed.
std::string shown_name(const TableRow& row);

/// Results beside published ones.
struct Table {
  std::string title;
  std::string group_title = "case", name_title = "pipeline";
  std::vector<TableColumn> columns;
  std::vector<TableRow> rows;
  std::vector<std::string> notes;
  std::vector<std::string> shown = {};  ///< keys of columns in Markdown and LaTeX, in their order; empty: all
};
/// The columns in Markdown and LaTeX.
std::vector<TableColumn> shown_columns(const Table& table);

/// The extensions of what a table is written to, and what writes them.
struct TableFormat {
  const char* extension;
  std::string (*print)(const Table&);
};
const std::vector<TableFormat>& table_formats();

/// A cell of ours with a published counterpart reads "ours (published, difference)". Values that have a
/// half-width are shown with two significant digits of it; where that leaves the range of the column, the
/// ends of what the range leaves of the interval stand in its place.
std::string to_markdown(const Table& table);
/// A longtable with booktabs, at 8 points, between paragraphs: a line above each group has its name. Columns
/// that do not fit beside each other on an A4 page stand below each other, and the notes below them.
std::string to_tex(const Table& table);
/// The same as floats over all columns of a page, with caption and label, and more floats where the groups
/// fill more than a page. `caption`: behind the title, in LaTeX.
std::string to_tex_floats(const Table& table, const std::string& label, const std::string& caption);
/// For each column: value, published value, difference.
std::string to_csv(const Table& table);
/// What the JSON of a table begins with: title, heads, columns; rows that are still empty; notes.
nlohmann::ordered_json json_without_rows(const Table& table);
std::string to_json(const Table& table);

/// How a format shows bold values, and texts that mean something to it.
struct TableStyle {
  const char *bold_begin, *bold_end, *plus_minus;
  std::string (*escape)(const std::string&);
};

/// A table as texts, ready to be set.
struct RenderedTable {
  struct Line {
    std::vector<std::string> names;   ///< group and name
    std::vector<std::string> values;  ///< by column
    std::string
        missing;  ///< in place of values: "failed", "skipped" or kNotApplicable; empty: they are there
  };
  Line head;
  std::vector<Line> lines;
  std::vector<std::string> notes;  ///< not escaped
};

/// The columns that are to be shown. `notes` say why rows failed, what brackets mean, and where published
/// values stand.
RenderedTable render(const Table& table, const TableStyle& style);

/// As fields of CSV: in quotes where it must be; every digit, and nothing of NaN.
std::string csv_quoted(const std::string& text);
std::string csv_number(double value);

double value_or_nan(const std::map<std::string, double>& values, const std::string& key);
std::string replace_all(std::string text, const std::string& from, const std::string& to);

/// With that many decimal places; halves are rounded away from 0, as on the page of results, and 0 has no
/// sign.
std::string number_text(double value, int decimals);
/// Decimal places with which a value and half the width of its interval are shown: two significant digits of
/// the half-width, so that rounding hides neither, but no more than 6, or 3 more than `digits`. `digits`: of
/// values that are exact; used where the half-width is 0, not known, or nothing in so many places.
int decimals_of(double half_width, int digits);
/// "0.43"; "< 0.001" where it would be rounded to nothing.
std::string half_width_text(double half_width, int decimals);
/// "[0.010, 0.015]".
std::string ends_text(const Interval& interval, int decimals);
/// "0.012 [0.010, 0.015]", with two significant digits of half the interval's width.
std::string interval_text(double value, const Interval& interval, int digits);

/// "0.0123"; "< 0.0001" below that.
std::string p_text(double p);

}  // namespace delquad
