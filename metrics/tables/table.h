// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <set>
#include <string>
#include <vector>

#include "metrics/tables/statistics.h"

// This header has tables and their formats. The bench and reports use it.

namespace delquad {

struct TableColumn {
  std::string key;                         ///< name in CSV and JSON
  std::string title;                       ///< title for people
  int digits = 0;                          ///< digits after the decimal point
  Interval range = {-HUGE_VAL, HUGE_VAL};  ///< range of its values
};

struct TableRow {
  std::string group, name;                  ///< first two columns: case and pipeline
  std::map<std::string, double> values;     ///< by column key; absent or NaN: not known
  std::map<std::string, double> published;  ///< published values, as printed
  std::string source;                       ///< source of published values; empty: none
  std::string failure;                      ///< reason of failure; empty: none
  std::string skipped = {};                 ///< why it was left out; empty: it was not
  /// Half-widths of the 95 % confidence intervals of means over several runs, by column key.
  std::map<std::string, double> half_widths = {};
  std::set<std::string> bold = {};  ///< keys of columns with proven values
  std::map<std::string, std::string> texts =
      {};                       ///< text in place of a value, by column key; absent: the number
  std::string unsound = {};     ///< number of unsound meshes; empty: none
  std::string incomplete = {};  ///< number of failed runs; empty: none, or all
};

/// Reason for leaving out a pipeline that does not suit the case: kind as in ProcessFailure, and status of
/// its record.
inline constexpr const char* kNotApplicable = "not applicable";
/// Column with the number of runs.
inline constexpr const char* kRuns = "n";
/// Column with the time of finish steps.
inline constexpr const char* kFinishSeconds = "finish_seconds";

/// Returns the second column, with remarks on unsound meshes and failed runs.
std::string shown_name(const TableRow& row);

/// Results beside published ones.
struct Table {
  std::string title;
  std::string group_title = "case", name_title = "pipeline";
  std::vector<TableColumn> columns;
  std::vector<TableRow> rows;
  std::vector<std::string> notes;
  std::vector<std::string> shown = {};  ///< keys of columns in Markdown and LaTeX, in order; empty: all
};
/// Returns the columns in Markdown and LaTeX.
std::vector<TableColumn> shown_columns(const Table& table);

/// Extension of a format of tables, and its writer.
struct TableFormat {
  const char* extension;
  std::string (*print)(const Table&);
};
const std::vector<TableFormat>& table_formats();

/// Returns the table in Markdown. A cell with a published counterpart is "ours (published, difference)".
/// Values with a half-width show two significant digits of it. If that leaves the range of the column, the
/// ends of the clamped interval replace it.
std::string to_markdown(const Table& table);
/// Returns a longtable with booktabs, at 8 points, for a place between paragraphs. A line above each group
/// has its name. Columns that do not fit on an A4 page follow below, then the notes.
std::string to_tex(const Table& table);
/// Returns floats over all columns of a page, with caption and label, and more floats if groups fill more
/// than a page. `caption` is LaTeX, and follows the title.
std::string to_tex_floats(const Table& table, const std::string& label, const std::string& caption);
/// Returns value, published value and difference for each column.
std::string to_csv(const Table& table);
/// Returns the head of a table's JSON: title, heads, columns, empty rows, notes.
nlohmann::ordered_json json_without_rows(const Table& table);
std::string to_json(const Table& table);

/// Marks of bold values and intervals in a format, and its escaping.
struct TableStyle {
  const char *bold_begin, *bold_end, *plus_minus;
  std::string (*escape)(const std::string&);
};

/// A table as texts.
struct RenderedTable {
  struct Line {
    std::vector<std::string> names;   ///< group and name
    std::vector<std::string> values;  ///< by column
    std::string missing;  ///< in place of values: "failed", "skipped" or kNotApplicable; empty: values exist
  };
  Line head;
  std::vector<Line> lines;
  std::vector<std::string> notes;  ///< not escaped
};

/// Returns the shown columns. `notes` explain failed rows, brackets, and sources of published values.
RenderedTable render(const Table& table, const TableStyle& style);

/// Returns a field of CSV: quoted if needed; numbers with all digits, and empty for NaN.
std::string csv_quoted(const std::string& text);
std::string csv_number(double value);

double value_or_nan(const std::map<std::string, double>& values, const std::string& key);
std::string replace_all(std::string text, const std::string& from, const std::string& to);

/// Returns a number with so many decimal places. Halves are rounded away from 0, as on the page of results,
/// and 0 has no sign.
std::string number_text(double value, int decimals);
/// Returns the decimal places for a value and its half-width: two significant digits of the half-width, at
/// most 6, or 3 more than `digits`. `digits` is for exact values; it also applies to a half-width that is 0,
/// unknown or negligible.
int decimals_of(double half_width, int digits);
/// Returns "0.43", or "< 0.001" if it would be rounded to 0.
std::string half_width_text(double half_width, int decimals);
/// Returns "[0.010, 0.015]".
std::string ends_text(const Interval& interval, int decimals);
/// Returns "0.012 [0.010, 0.015]", with two significant digits of half the interval's width.
std::string interval_text(double value, const Interval& interval, int digits);

/// Returns "0.0123", or "< 0.0001" below that.
std::string p_text(double p);

}  // namespace delquad
