// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrics/tables/summary.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <map>
#include <set>

namespace delquad {
namespace {

using Runs = std::vector<const CellRecord*>;

/// A pipeline, or a value of an axis, with runs.
struct Contestant {
  std::string name;
  Runs runs;
  std::size_t rivals = 0, failed = 0;  ///< others of its kind; failed domains
};

/// Adds the findings of its pairs in a measure.
void add_pairs(const Contestant& one, const std::string& key, const Inference& inference, TableRow& row) {
  std::map<std::string, std::set<int>> ways;  // by domain: above, below or like another
  std::vector<std::string> beaten;
  bool is_compared = false, is_whole = true;
  for (const PairComparison& pair : inference.pairs()) {
    if (pair.metric.key != key || (pair.first != one.name && pair.second != one.name)) continue;
    is_compared = true;
    const bool is_first = pair.first == one.name;
    const int sign = is_first == (pair.metric.better == Better::kHigher) ? 1 : -1;
    const PairedDomains& domains = pair.domains;
    for (std::size_t k = 0; k < domains.names.size(); ++k)
      ways[domains.names[k]].insert(sign * ((domains.differences[k] > 0) - (domains.differences[k] < 0)));
    if (inference.first_is_better(pair) != is_first) continue;
    const std::string failures = pair.failures();
    beaten.push_back((is_first ? pair.second : pair.first) + (failures.empty() ? "" : " (" + failures + ")"));
    is_whole = is_whole && failures.empty();
  }
  row.texts["better_than"] = beaten.empty() ? "-" : fmt::format("{}", fmt::join(beaten, ", "));
  if (one.rivals > 0 && beaten.size() == one.rivals && is_whole) row.bold.insert("mean");
  if (!is_compared) return;
  for (const auto& [name, way] : {std::pair("won", 1), {"lost", -1}})
    row.values[name] = static_cast<double>(
        std::ranges::count_if(ways, [&](const auto& of) { return of.second == std::set{way}; }));
}

TableRow row_of(const Contestant& one, const Metric& metric, const Inference& inference) {
  TableRow row{metric.title, one.name, {}, {}, "", ""};
  const std::vector<double> means = means_by_domain(one.runs, metric.key);
  row.values["domains"] = static_cast<double>(means.size());
  row.values["failed"] = static_cast<double>(one.failed);
  if (means.empty()) return row;
  row.values["mean"] = mean(means);
  row.texts["mean"] = number_text(mean(means), metric.digits);
  if (auto interval = interval_of_mean(means)) {
    const Interval range = range_of(metric.key);
    interval = {std::max(interval->low, range.low), std::min(interval->high, range.high)};
    row.values["low"] = interval->low;
    row.values["high"] = interval->high;
    row.texts["mean"] = interval_text(mean(means), *interval, metric.digits);
  }
  add_pairs(one, metric.key, inference, row);
  return row;
}

std::vector<Contestant> contestants_of(const std::string& along, const std::vector<std::string>& values,
                                       const std::vector<CellRecord>& records) {
  std::vector<Contestant> all;
  for (const std::string& value : values) {
    Contestant one{along.empty() ? value : along + "=" + value, {}};
    std::set<std::string> failed;
    for (const CellRecord& record : records) {
      if (record.skipped || value_along(record, along) != value) continue;
      makes_quads(record) ? one.runs.push_back(&record) : void(failed.insert(domain_of(record)));
    }
    one.failed = failed.size();
    if (!one.runs.empty()) all.push_back(std::move(one));
  }
  for (Contestant& one : all) one.rivals = all.size() - 1;
  return all;
}

}  // namespace

Table summarise(const StudyFile& study, const std::vector<CellRecord>& records, const Inference& inference) {
  const bool of_axes = study.pipelines.size() == 1 && !study.pairs.empty();
  std::set<std::string> domains;
  for (const CellRecord& record : records)
    if (makes_quads(record)) domains.insert(domain_of(record));
  Table table{study.title + ": summary", "measure", of_axes ? "value" : "pipeline", {}, {}, {}};
  if (domains.size() < 2) return table;
  std::vector<Contestant> all;
  if (!of_axes) all = contestants_of("", study.pipelines, records);
  for (const auto& [title, values] : study.axes)
    if (of_axes && std::ranges::find(study.pairs, title) != study.pairs.end())
      std::ranges::move(contestants_of(title, values, records), std::back_inserter(all));
  table.columns = {{"domains", "domains", 0}, {"failed", "failed", 0},
                   {"mean", "mean", 0},       {"low", "low", 4},
                   {"high", "high", 4},       {"won", "won", 0},
                   {"lost", "lost", 0},       {"better_than", "proven better than", 0}};
  table.shown = {"domains", "mean", "won", "lost", "better_than"};
  if (std::ranges::any_of(all, [](const Contestant& one) { return one.failed > 0; }))
    table.shown.insert(table.shown.begin() + 1, "failed");
  std::size_t fewest = std::numeric_limits<std::size_t>::max(), most = 0;
  for (const Metric& metric : compared_measures(study, records))
    for (const Contestant& one : all) {
      TableRow row = row_of(one, metric, inference);
      const auto n = static_cast<std::size_t>(row.values["domains"]);
      fewest = std::min(fewest, n);
      most = std::max(most, n);
      if (n > 0) table.rows.push_back(std::move(row));
    }
  table.notes = {
      "Means of the domains' (geometries') means over their variants and seeds, with 95 % intervals.",
      "Won: domains on which it is better than every other one, by the mean difference of each pair there. "
      "Lost: those on which it is worse than every other. Ties are neither. Who failed on a domain is worse "
      "there.",
      "Proven better than: at 5 %. Bold: than all others, without a failure. " + inference.family().note()};
  if (fewest < most)
    table.notes.emplace_back(
        "Those with fewer domains have no value on the others: their means are over other domains.");
  return table;
}

}  // namespace delquad
