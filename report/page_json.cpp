#include "report/page_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <set>

#include "delquad/extend.h"
#include "experiments/sweep/experiment.h"
#include "io/svg.h"
#include "metrics/metrics.h"
#include "metrics/tables/samples.h"
#include "metrics/tables/statistics.h"
#include "report/packed_mesh.h"

namespace delquad {
namespace {

Json values_json(const std::map<std::string, double>& values) {
  Json json = Json::object();
  for (const auto& [key, value] : values)
    if (!std::isnan(value)) json[key] = value;
  return json;
}

Json law_json(const std::vector<double>& elements, const std::vector<double>& seconds) {
  constexpr std::size_t kFewestSizes = 3;
  constexpr double kLeastRatio = 4;
  const std::set<double> sizes(elements.begin(), elements.end());
  if (sizes.size() < kFewestSizes || *sizes.rbegin() < kLeastRatio * *sizes.begin()) return Json();
  const auto law = fit_power_law(elements, seconds);
  return law ? Json{{"factor", law->factor}, {"exponent", law->exponent}} : Json();
}

const char* name_of(Better better) {
  switch (better) {
    case Better::kHigher:
      return "higher";
    case Better::kLower:
      return "lower";
    case Better::kNeither:
      return "";
  }
  return "";
}

constexpr const char* kSeed = "seed";

bool is_known(const std::vector<CellRecord>& records, const std::string& key) {
  return std::ranges::any_of(records,
                             [&](const CellRecord& record) { return std::isfinite(value_of(record, key)); });
}

/// Numbers texts in the order in which they come.
class Names {
 public:
  std::size_t of(const std::string& name) {
    const auto [at, is_new] = places_.try_emplace(name, names_.size());
    if (is_new) names_.push_back(name);
    return at->second;
  }
  const Json& list() const { return names_; }

 private:
  std::map<std::string, std::size_t> places_;
  Json names_ = Json::array();
};

/// The texts of a table's files by extension, packed: what one saves from the page is what a run writes.
Json table_files_json(const Table& table) {
  Json json = Json::object();
  for (const auto& [extension, print] : table_formats())
    if (const std::string name = extension; name != ".json") json[name.substr(1)] = packed_text(print(table));
  return json;
}

}  // namespace

Json table_json(const Table& table) {
  if (table.rows.empty()) return Json();
  Json json = json_without_rows(table);
  json["files"] = table_files_json(table);
  if (!table.shown.empty()) json["shown"] = table.shown;
  for (const TableRow& row : table.rows) {
    Json marks = Json::object();
    for (const auto& [key, mark] : row.marks) marks[key] = mark == Mark::kBest ? "best" : "as good";
    json["rows"].push_back({{"group", row.group},
                            {"name", shown_name(row)},
                            {"values", values_json(row.values)},
                            {"published", values_json(row.published)},
                            {"half_widths", values_json(row.half_widths)},
                            {"marks", marks},
                            {"texts", row.texts},
                            {"source", row.source},
                            {"failure", row.failure},
                            {"skipped", row.skipped}});
  }
  return json;
}

Json growth_json(const std::vector<CellRecord>& records) {
  struct Line {
    std::string word, name;
    std::vector<double> elements, seconds;
    Json points = Json::array();
  };
  std::vector<Line> lines;
  for (const CellRecord& record : records) {
    const auto n = record.values.find("n_elements"), s = record.values.find("seconds_total");
    if (n == record.values.end() || s == record.values.end() || !(n->second > 0) || !(s->second > 0))
      continue;
    auto line = std::ranges::find_if(
        lines, [&](const Line& l) { return l.word == record.pipeline && l.name == record.name; });
    if (line == lines.end()) line = lines.insert(lines.end(), {record.pipeline, record.name, {}, {}});
    line->elements.push_back(n->second);
    line->seconds.push_back(s->second);
    line->points.push_back({n->second, s->second, record.group});
  }
  Json json = Json::array();
  for (const Line& line : lines)
    json.push_back({{"word", line.word},
                    {"case", line.name},
                    {"points", line.points},
                    {"law", law_json(line.elements, line.seconds)}});
  return json;
}

Json glossary_json() {
  constexpr int kColours = 64;
  Json json = {{"letters", Json::array()}, {"metrics", Json::array()}, {"colours", Json::array()}};
  for (const Stage& stage : stage_registry())
    json["letters"].push_back({{"letter", std::string(1, stage.letter)}, {"name", stage.name}});
  for (const Metric& metric : metric_registry())
    json["metrics"].push_back({{"key", metric.key},
                               {"title", metric.title},
                               {"unit", metric.unit},
                               {"better", name_of(metric.better)},
                               {"source", metric.source}});
  json["steps"] = Json::array();
  for (const StepTime& time : step_times_of_tables())
    if (*time.step != 0) json["steps"].push_back(time.step);
  json["steps"].push_back("peer");
  for (int k = 0; k < kColours; ++k) json["colours"].push_back(svg::colour((k + 0.5) / kColours));
  json["marks"] = {{"one less", svg::mark_colour(1)},
                   {"one more", svg::mark_colour(-1)},
                   {"other", svg::mark_colour(0)},
                   {"pair", svg::kPairColour}};
  return json;
}

std::string seed_of(const CellRecord& record) {
  for (const auto& [title, value] : record.variant)
    if (title == kSeed) return value;
  return "";
}

Json means_json(std::span<const CellRecord* const> cells, const std::vector<TableColumn>& columns) {
  std::vector<std::pair<std::string, std::vector<const CellRecord*>>> words;
  for (const CellRecord* cell : cells) {
    if (!cell->reason.empty()) continue;
    auto word = std::ranges::find(words, cell->pipeline, [](const auto& w) { return w.first; });
    if (word == words.end()) word = words.insert(words.end(), {cell->pipeline, {}});
    word->second.push_back(cell);
  }
  Json json = Json::array();
  if (std::ranges::none_of(words, [](const auto& w) { return w.second.size() > 1; })) return json;
  for (const auto& [word, done] : words) {
    Json line = {
        {"word", word}, {"n", done.size()}, {"values", Json::object()}, {"half_widths", Json::object()}};
    for (const TableColumn& column : columns) {
      std::vector<double> values;
      for (const CellRecord* cell : done)
        if (const double v = value_of(*cell, column.key); std::isfinite(v)) values.push_back(v);
      if (!values.empty()) line["values"][column.key] = mean(values);
      if (values.size() > 1) line["half_widths"][column.key] = confidence_half_width(values);
    }
    json.push_back(std::move(line));
  }
  return json;
}

Json samples_json(const std::vector<CellRecord>& records, const std::vector<TableColumn>& columns) {
  Json keys = Json::array(), cells = Json::array(), cases = Json::array();
  for (const TableColumn& column : columns)
    if (is_known(records, column.key)) keys.push_back({{"key", column.key}, {"title", column.title}});
  Names sheets, words;
  for (const CellRecord& record : records) {
    if (!record.reason.empty()) continue;
    Json cell = {sheets.of(row_group(record)), words.of(record.pipeline)};
    if (cases.size() < sheets.list().size()) cases.push_back(record.name);
    for (const Json& key : keys)
      cell.push_back(brief_number(value_of(record, key["key"].get<std::string>())));
    cells.push_back(std::move(cell));
  }
  return {
      {"sheets", sheets.list()}, {"cases", cases}, {"words", words.list()}, {"keys", keys}, {"cells", cells}};
}

Json brief_number(double value) {
  if (!std::isfinite(value)) return Json();
  return std::strtod(fmt::format("{:.5g}", value).c_str(), nullptr);
}

}  // namespace delquad
