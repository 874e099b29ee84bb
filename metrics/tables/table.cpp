// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrics/tables/table.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

namespace delquad {

namespace {

using Json = nlohmann::ordered_json;

/// Returns the most useful decimal places of values whose exact ones have `digits`.
int most_decimals(int digits) { return std::max(6, digits + 3); }

/// Returns whether the rest is exactly half of the last place.
bool is_tie(double value, int decimals) {
  return std::fmod(std::ldexp(std::abs(value), decimals + 1), 2) == 1;
}

}  // namespace

std::string number_text(double value, int decimals) {
  if (is_tie(value, decimals)) value = std::nextafter(value, std::copysign(HUGE_VAL, value));
  const std::string text = fmt::format("{:.{}f}", value, decimals);
  const bool is_zero = text.find_first_not_of("-0.") == std::string::npos;
  return is_zero && text[0] == '-' ? text.substr(1) : text;
}

int decimals_of(double half_width, int digits) {
  const int most = most_decimals(digits);
  if (!(half_width >= std::pow(10.0, -most) / 2) || std::isinf(half_width)) return digits;
  const double order = std::floor(std::log10(half_width));
  return std::clamp(static_cast<int>(1 - order), 0, most);
}

std::string half_width_text(double half_width, int decimals) {
  const double unit = std::pow(10.0, -decimals);
  if (half_width > 0 && half_width < unit / 2) return fmt::format("< {:.{}f}", unit, decimals);
  return number_text(half_width, decimals);
}

std::string ends_text(const Interval& interval, int decimals) {
  return fmt::format("[{}, {}]", number_text(interval.low, decimals), number_text(interval.high, decimals));
}

std::string interval_text(double value, const Interval& interval, int digits) {
  const int decimals = decimals_of((interval.high - interval.low) / 2, digits);
  return number_text(value, decimals) + " " + ends_text(interval, decimals);
}

std::string p_text(double p) {
  constexpr double kLeastShown = 0.0001;
  return p < kLeastShown ? "< 0.0001" : fmt::format("{:.4f}", p);
}

std::string csv_quoted(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  return fmt::format("\"{}\"", replace_all(text, "\"", "\"\""));
}

std::string csv_number(double value) { return std::isnan(value) ? "" : fmt::format("{}", value); }

namespace {

/// Returns the number of characters in UTF-8.
std::size_t characters(const std::string& text) {
  return static_cast<std::size_t>(
      std::ranges::count_if(text, [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

std::string markdown_escaped(const std::string& text) { return replace_all(text, "|", "\\|"); }

constexpr TableStyle kMarkdown = {"**", "**", " \u00b1 ", markdown_escaped};
/// Returns the cells of a line; "failed" is in place of its first value.
std::vector<std::string> cells_of(const RenderedTable::Line& line) {
  std::vector<std::string> cells = line.names;
  bool said = line.missing.empty();
  for (const std::string& value : line.values) {
    cells.push_back(!said && value.empty() ? line.missing : value);
    said = said || value.empty();
  }
  return cells;
}

std::string status(const TableRow& row) {
  if (!row.failure.empty()) return "failed: " + row.failure;
  if (!row.skipped.empty()) return row.skipped == kNotApplicable ? row.skipped : "skipped: " + row.skipped;
  if (row.unsound.empty() && row.incomplete.empty()) return "ok";
  return row.unsound + (row.unsound.empty() || row.incomplete.empty() ? "" : ", ") + row.incomplete;
}

/// Returns the number, or the text that replaces it.
std::string csv_value(const TableRow& row, const std::string& key) {
  const auto text = row.texts.find(key);
  const double value = value_or_nan(row.values, key);
  return std::isnan(value) && text != row.texts.end() ? csv_quoted(text->second) : csv_number(value);
}

/// Returns whether the 95 % interval extends beyond possible values.
bool leaves_range(double value, double half_width, const Interval& range) {
  const bool is_inside = value >= range.low && value <= range.high;
  return is_inside && (value - half_width < range.low || value + half_width > range.high);
}

/// Returns the half-width of a mean's interval, or the ends of the clamped interval.
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
  if (row.bold.contains(column.key)) text = style.bold_begin + text + style.bold_end;
  text += spread_text(ours, half_width, column, style);
  if (std::isnan(published)) return text;
  if (std::isnan(ours)) return fmt::format("{} ({})", text, published);
  return fmt::format("{} ({}, {})", text, published, difference_text(ours - published, decimals));
}

/// Returns the text in place of missing values; empty: none is missing.
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

const std::vector<TableFormat>& table_formats() {
  static const std::vector<TableFormat> formats = {
      {".md", to_markdown}, {".csv", to_csv}, {".tex", to_tex}, {".json", to_json}};
  return formats;
}

std::string shown_name(const TableRow& row) {
  std::string name = row.name;
  if (!row.unsound.empty()) name += " (" + row.unsound + ")";
  if (!row.incomplete.empty()) name += " (" + row.incomplete + ")";
  return name;
}

std::vector<TableColumn> shown_columns(const Table& table) {
  if (table.shown.empty()) return table.columns;
  std::vector<TableColumn> columns;
  for (const std::string& key : table.shown) {
    const auto at = std::ranges::find(table.columns, key, &TableColumn::key);
    if (at != table.columns.end()) columns.push_back(*at);
  }
  return columns;
}

std::string to_markdown(const Table& table) {
  const RenderedTable rendered = render(table, kMarkdown);
  std::vector<std::vector<std::string>> lines = {cells_of(rendered.head)};
  for (const RenderedTable::Line& line : rendered.lines) lines.push_back(cells_of(line));
  std::vector<std::size_t> width(lines[0].size(), 3);
  for (const auto& line : lines)
    for (std::size_t k = 0; k < line.size(); ++k) width[k] = std::max(width[k], characters(line[k]));
  std::string text = fmt::format("# {}\n\n", table.title);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    text += "|";
    for (std::size_t k = 0; k < width.size(); ++k) {
      const std::string padding(width[k] - characters(lines[i][k]), ' ');
      text += " " + (k < 2 ? lines[i][k] + padding : padding + lines[i][k]) + " |";
    }
    text += "\n";
    if (i > 0) continue;
    text += "|";
    for (std::size_t k = 0; k < width.size(); ++k)
      text += k < 2 ? std::string(width[k] + 2, '-') + "|" : std::string(width[k] + 1, '-') + ":|";
    text += "\n";
  }
  if (!rendered.notes.empty()) text += "\n";
  for (const std::string& note : rendered.notes) text += fmt::format("- {}\n", replace_all(note, "\n", " "));
  return text;
}

std::string to_csv(const Table& table) {
  std::string text = csv_quoted(table.group_title) + "," + csv_quoted(table.name_title) + ",status,source";
  for (const TableColumn& column : table.columns)
    text += fmt::format(",{0},{0}_half_width,{0}_published,{0}_difference", column.key);
  text += "\n";
  for (const TableRow& row : table.rows) {
    text += csv_quoted(row.group) + "," + csv_quoted(row.name) + "," + csv_quoted(status(row)) + "," +
            csv_quoted(row.source);
    for (const TableColumn& column : table.columns) {
      const double ours = value_or_nan(row.values, column.key),
                   published = value_or_nan(row.published, column.key);
      text += fmt::format(",{},{},{},{}", csv_value(row, column.key),
                          csv_number(value_or_nan(row.half_widths, column.key)), csv_number(published),
                          csv_number(ours - published));
    }
    text += "\n";
  }
  return text;
}

nlohmann::ordered_json json_without_rows(const Table& table) {
  Json json = {{"title", table.title},
               {"heads", {table.group_title, table.name_title}},
               {"columns", Json::array()},
               {"rows", Json::array()},
               {"notes", table.notes}};
  for (const TableColumn& column : table.columns) {
    json["columns"].push_back({{"key", column.key}, {"title", column.title}, {"digits", column.digits}});
    if (std::isfinite(column.range.low) || std::isfinite(column.range.high))
      json["columns"].back()["range"] = {column.range.low, column.range.high};
  }
  return json;
}

namespace {

/// Returns the row's values by column.
nlohmann::ordered_json by_column(const Table& table, const std::map<std::string, double>& values) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const TableColumn& column : table.columns)
    if (values.contains(column.key)) json[column.key] = values.at(column.key);
  return json;
}

}  // namespace

std::string to_json(const Table& table) {
  Json json = json_without_rows(table);
  for (const TableRow& row : table.rows) {
    Json line = {{table.group_title, row.group}, {table.name_title, row.name}};
    if (!row.failure.empty() || !row.skipped.empty()) {
      line["status"] = row.failure.empty() ? "skipped" : "failed";
      line["reason"] = row.failure.empty() ? row.skipped : row.failure;
    } else {
      line["status"] = "ok";
      if (!row.unsound.empty()) line["unsound"] = row.unsound;
      if (!row.incomplete.empty()) line["incomplete"] = row.incomplete;
      line["values"] = by_column(table, row.values);
      if (!row.half_widths.empty()) line["half_widths"] = by_column(table, row.half_widths);
      if (!row.bold.empty()) line["bold"] = row.bold;
      if (!row.texts.empty()) line["texts"] = row.texts;
    }
    if (!row.published.empty()) {
      line["published"] = by_column(table, row.published);
      std::map<std::string, double> difference;
      for (const auto& [key, value] : row.published)
        if (row.values.contains(key)) difference[key] = row.values.at(key) - value;
      line["difference"] = by_column(table, difference);
      line["source"] = row.source;
    }
    json["rows"].push_back(std::move(line));
  }
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

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
