#include "sweep/table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "delquad/error.h"
#include "sweep/peer.h"

namespace delquad {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

double value_or_nan(const std::map<std::string, double>& values, const std::string& key) {
  const auto at = values.find(key);
  return at == values.end() ? kUnknown : at->second;
}

/// How a format shows what is the best, and what is perhaps as good.
struct Style {
  const char *best_begin, *best_end, *as_good, *plus_minus;
};
constexpr Style kMarkdown = {"**", "**", "~", " \u00b1 "};
constexpr Style kTex = {"\\textbf{", "}", "$\\sim$", " $\\pm$ "};

std::string cell(const TableRow& row, const TableColumn& column, const Style& style) {
  const double ours = value_or_nan(row.values, column.key),
               published = value_or_nan(row.published, column.key),
               half_width = value_or_nan(row.half_widths, column.key);
  std::string text = std::isnan(ours) ? "-" : fmt::format("{:.{}f}", ours, column.digits);
  if (const auto mark = row.marks.find(column.key); mark != row.marks.end())
    text = mark->second == Mark::kBest ? style.best_begin + text + style.best_end : style.as_good + text;
  if (!std::isnan(half_width)) text += fmt::format("{}{:.{}f}", style.plus_minus, half_width, column.digits);
  if (std::isnan(published)) return text;
  if (std::isnan(ours)) return fmt::format("{} ({})", text, published);
  return fmt::format("{} ({}, {:+.{}f})", text, published, ours - published, column.digits);
}

std::string replace_all(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
  return text;
}

std::string tex_escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '\\')
      result += "\\textbackslash{}";
    else if (c == '^' || c == '~')
      result += fmt::format("\\{}{{}}", c);
    else if (std::string("&%$#_{}").find(c) != std::string::npos)
      result += fmt::format("\\{}", c);
    else
      result += c;
  }
  return result;
}

/// Of UTF-8.
std::size_t characters(const std::string& text) {
  return static_cast<std::size_t>(
      std::ranges::count_if(text, [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

/// What stands in place of values where there are none; empty: there are.
std::string shown_skip(const TableRow& row) {
  return row.skipped.empty() ? "" : row.skipped == kNotApplicable ? row.skipped : "skipped";
}

std::string markdown_escaped(const std::string& text) { return replace_all(text, "|", "\\|"); }

/// Header and body as text; a failed row's reason goes to the notes.
struct Rendered {
  std::vector<std::vector<std::string>> lines;  // the first is the header
  std::vector<std::string> notes;
};

Rendered render(const Table& table, const Style& style, std::string (*escape)(const std::string&)) {
  Rendered result;
  result.lines.push_back({escape(table.group_title), escape(table.name_title)});
  for (const TableColumn& column : table.columns) result.lines.back().push_back(escape(column.title));
  bool compared = false, as_good = false, means = false;
  for (const TableRow& row : table.rows) {
    std::vector<std::string> line = {escape(row.group), escape(shown_name(row))};
    for (const TableColumn& column : table.columns) {
      const bool first = line.size() == 2;
      const std::string missing = !row.failure.empty() ? "failed" : shown_skip(row);
      line.push_back(missing.empty() ? cell(row, column, style) : first ? missing : "");
    }
    result.lines.push_back(std::move(line));
    compared = compared || !row.published.empty();
    means = means || !row.half_widths.empty();
    for (const auto& [key, mark] : row.marks) as_good = as_good || mark == Mark::kAsGoodAsBest;
    if (!row.failure.empty())
      result.notes.push_back(fmt::format("{} {} failed: {}", row.group, row.name, row.failure));
  }
  if (means) result.notes.push_back("Means, and half the width of their 95 % confidence intervals.");
  if (as_good) result.notes.push_back("~: no difference is proven (Wilcoxon's signed-rank test, 5 %).");
  if (compared) result.notes.push_back("In brackets: the published number, and ours minus it.");
  for (const TableRow& row : table.rows)
    if (!row.source.empty())
      result.notes.push_back(fmt::format("{} {}: {}", row.group, row.name, row.source));
  result.notes.insert(result.notes.end(), table.notes.begin(), table.notes.end());
  return result;
}

std::string csv_quoted(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  return fmt::format("\"{}\"", replace_all(text, "\"", "\"\""));
}

std::string status(const TableRow& row) {
  if (!row.failure.empty()) return "failed: " + row.failure;
  if (!row.skipped.empty()) return row.skipped == kNotApplicable ? row.skipped : "skipped: " + row.skipped;
  return row.unsound.empty() ? "ok" : row.unsound;
}

std::string csv_number(double value) { return std::isnan(value) ? "" : fmt::format("{}", value); }

}  // namespace

const std::vector<TableFormat>& table_formats() {
  static const std::vector<TableFormat> formats = {
      {".md", to_markdown}, {".csv", to_csv}, {".tex", to_tex}, {".json", to_json}};
  return formats;
}

std::string shown_name(const TableRow& row) {
  return row.unsound.empty() ? row.name : row.name + " (" + row.unsound + ")";
}

std::string to_markdown(const Table& table) {
  const Rendered rendered = render(table, kMarkdown, markdown_escaped);
  std::vector<std::size_t> width(rendered.lines[0].size(), 3);
  for (const auto& line : rendered.lines)
    for (std::size_t k = 0; k < line.size(); ++k) width[k] = std::max(width[k], characters(line[k]));
  std::string text = fmt::format("# {}\n\n", table.title);
  for (std::size_t i = 0; i < rendered.lines.size(); ++i) {
    text += "|";
    for (std::size_t k = 0; k < width.size(); ++k) {
      const std::string& content = rendered.lines[i][k];
      const std::string padding(width[k] - characters(content), ' ');
      text += " " + (k < 2 ? content + padding : padding + content) + " |";
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

std::string to_tex(const Table& table) {
  const Rendered rendered = render(table, kTex, tex_escaped);
  std::string text = fmt::format("% {}\n\\begin{{tabular}}{{ll{}}}\n\\toprule\n",
                                 replace_all(table.title, "\n", " "), std::string(table.columns.size(), 'r'));
  for (std::size_t i = 0; i < rendered.lines.size(); ++i) {
    for (std::size_t k = 0; k < rendered.lines[i].size(); ++k)
      text.append(k ? " & " : "").append(rendered.lines[i][k]);
    text += i == 0 ? " \\\\\n\\midrule\n" : " \\\\\n";
  }
  text += "\\bottomrule\n\\end{tabular}\n";
  for (const std::string& note : rendered.notes) text += fmt::format("% {}\n", replace_all(note, "\n", " "));
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
      text +=
          fmt::format(",{},{},{},{}", csv_number(ours), csv_number(value_or_nan(row.half_widths, column.key)),
                      csv_number(published), csv_number(ours - published));
    }
    text += "\n";
  }
  return text;
}

nlohmann::ordered_json json_without_rows(const Table& table) {
  using Json = nlohmann::ordered_json;
  Json json = {{"title", table.title},
               {"heads", {table.group_title, table.name_title}},
               {"columns", Json::array()},
               {"rows", Json::array()},
               {"notes", table.notes}};
  for (const TableColumn& column : table.columns)
    json["columns"].push_back({{"key", column.key}, {"title", column.title}, {"digits", column.digits}});
  return json;
}

std::string to_json(const Table& table) {
  using Json = nlohmann::ordered_json;
  const auto object = [&](const std::map<std::string, double>& values) {
    Json json = Json::object();
    for (const TableColumn& column : table.columns)
      if (values.contains(column.key)) json[column.key] = values.at(column.key);
    return json;
  };
  Json json = json_without_rows(table);
  for (const TableRow& row : table.rows) {
    Json line = {{table.group_title, row.group}, {table.name_title, row.name}};
    if (!row.failure.empty() || !row.skipped.empty()) {
      line["status"] = row.failure.empty() ? "skipped" : "failed";
      line["reason"] = row.failure.empty() ? row.skipped : row.failure;
    } else {
      line["status"] = "ok";
      if (!row.unsound.empty()) line["unsound"] = row.unsound;
      line["values"] = object(row.values);
      if (!row.half_widths.empty()) line["half_widths"] = object(row.half_widths);
    }
    if (!row.published.empty()) {
      line["published"] = object(row.published);
      std::map<std::string, double> difference;
      for (const auto& [key, value] : row.published)
        if (row.values.contains(key)) difference[key] = row.values.at(key) - value;
      line["difference"] = object(difference);
      line["source"] = row.source;
    }
    json["rows"].push_back(std::move(line));
  }
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

Table read_table(const std::filesystem::path& file) {
  using Json = nlohmann::ordered_json;
  try {
    std::ifstream in(file);
    const Json json = Json::parse(in);
    Table table;
    json.at("title").get_to(table.title);
    table.group_title = json.at("heads").at(0);
    table.name_title = json.at("heads").at(1);
    json.at("notes").get_to(table.notes);
    for (const Json& column : json.at("columns"))
      table.columns.push_back({column.at("key"), column.at("title"), column.at("digits")});
    for (const Json& line : json.at("rows")) {
      TableRow row{line.at(table.group_title), line.at(table.name_title), {}, {}, "", ""};
      if (line.at("status") != "ok")
        (line.at("status") == "failed" ? row.failure : row.skipped) = line.at("reason");
      if (line.contains("values"))
        for (const auto& [key, value] : line["values"].items())
          if (!value.is_null()) row.values[key] = value;
      table.rows.push_back(std::move(row));
    }
    return table;
  } catch (const Json::exception& error) {
    throw InputError(fmt::format("{}: is no table of results: {}", file.string(), error.what()));
  }
}

}  // namespace delquad
