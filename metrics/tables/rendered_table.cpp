#include "metrics/tables/rendered_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "metrics/tables/cell_text.h"

namespace delquad {
namespace {

/// Whether the 95 % interval goes on where no value can be.
bool leaves_range(double value, double half_width, const Interval& range) {
  const bool is_inside = value >= range.low && value <= range.high;
  return is_inside && (value - half_width < range.low || value + half_width > range.high);
}

/// What stands behind a mean: half the width of its interval, or the ends of what the range leaves of it.
std::string spread_text(double value, double half_width, const TableColumn& column, const TableStyle& style) {
  if (std::isnan(half_width)) return "";
  const int decimals = decimals_of(half_width, column.digits);
  const Interval& range = column.range;
  const bool is_hidden = half_width_text(half_width, decimals)[0] == '<';
  if (is_hidden || !leaves_range(value, half_width, range))
    return style.plus_minus + style.escape(half_width_text(half_width, decimals));
  return " " + ends_text({std::max(value - half_width, range.low), std::min(value + half_width, range.high)},
                         decimals);
}

std::string difference_text(double difference, int decimals) {
  return (difference < 0 ? "" : "+") + number_text(difference, decimals);
}

std::string cell(const TableRow& row, const TableColumn& column, const TableStyle& style) {
  const double ours = value_or_nan(row.values, column.key),
               published = value_or_nan(row.published, column.key),
               half_width = value_or_nan(row.half_widths, column.key);
  const int decimals = decimals_of(half_width, column.digits);
  std::string text = std::isnan(ours) ? "-" : number_text(ours, decimals);
  if (const auto own = row.texts.find(column.key); own != row.texts.end()) text = style.escape(own->second);
  if (const auto mark = row.marks.find(column.key); mark != row.marks.end())
    text = mark->second == Mark::kBest ? style.best_begin + text + style.best_end : style.as_good + text;
  text += spread_text(ours, half_width, column, style);
  if (std::isnan(published)) return text;
  if (std::isnan(ours)) return fmt::format("{} ({})", text, published);
  return fmt::format("{} ({}, {})", text, published, difference_text(ours - published, decimals));
}

/// What stands in place of values where there are none; empty: there are.
std::string shown_skip(const TableRow& row) {
  return row.skipped.empty() ? "" : row.skipped == kNotApplicable ? row.skipped : "skipped";
}

RenderedTable::Line line_of(const TableRow& row, const std::vector<TableColumn>& columns,
                            const TableStyle& style) {
  RenderedTable::Line line{{style.escape(row.group), style.escape(shown_name(row))}, {}, ""};
  line.missing = row.failure.empty() ? shown_skip(row) : "failed";
  for (const TableColumn& column : columns)
    line.values.push_back(line.missing.empty() || column.key == kRuns ? cell(row, column, style) : "");
  return line;
}

void add_notes(const Table& table, std::vector<std::string>& notes) {
  bool compared = false, means = false;
  for (const TableRow& row : table.rows) {
    compared = compared || !row.published.empty();
    means = means || !row.half_widths.empty();
    if (!row.failure.empty())
      notes.push_back(fmt::format("{} {} failed: {}", row.group, row.name, row.failure));
  }
  if (means)
    notes.push_back(
        "Means, and half the width of their 95 % confidence intervals, or their ends where the measure can "
        "go no "
        "further.");
  if (compared) notes.push_back("In brackets: the published number, and ours minus it.");
  for (const TableRow& row : table.rows)
    if (!row.source.empty()) notes.push_back(fmt::format("{} {}: {}", row.group, row.name, row.source));
  notes.insert(notes.end(), table.notes.begin(), table.notes.end());
}

}  // namespace

RenderedTable render(const Table& table, const TableStyle& style) {
  const std::vector<TableColumn> columns = shown_columns(table);
  RenderedTable result;
  result.head.names = {style.escape(table.group_title), style.escape(table.name_title)};
  for (const TableColumn& column : columns) result.head.values.push_back(style.escape(column.title));
  for (const TableRow& row : table.rows) result.lines.push_back(line_of(row, columns, style));
  add_notes(table, result.notes);
  return result;
}

double value_or_nan(const std::map<std::string, double>& values, const std::string& key) {
  const auto at = values.find(key);
  return at == values.end() ? std::numeric_limits<double>::quiet_NaN() : at->second;
}

std::string replace_all(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
  return text;
}

}  // namespace delquad
