#include "report/page_json.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "delquad/extend.h"
#include "experiments/sweep/experiment.h"
#include "io/svg.h"
#include "metrics/metrics.h"
#include "metrics/tables/statistics.h"
#include "report/packed_text.h"

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

}  // namespace

Json table_files_json(const Table& table) {
  Json json = Json::object();
  for (const auto& [extension, print] : table_formats())
    if (const std::string name = extension; name != ".json") json[name.substr(1)] = packed_text(print(table));
  return json;
}

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

}  // namespace delquad
