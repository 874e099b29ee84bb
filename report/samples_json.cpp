#include "report/samples_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>

#include "metrics/tables/samples.h"
#include "metrics/tables/statistics.h"

namespace delquad {
namespace {

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

}  // namespace

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
