#include "metrics/tables/summary.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <optional>
#include <set>

namespace delquad {
namespace {

constexpr const char *kDomains = "domains", *kBetterThan = "better_than";

using Runs = std::vector<const CellRecord*>;

/// What a row has in a measure, over domains.
struct Standing {
  std::size_t domains = 0;
  double mean = std::nan("");
  std::optional<Interval> interval = {};
  int won = 0, lost = 0;
  bool is_compared = false;
  std::vector<std::string> beaten = {};  ///< rows than which it is proven to be better
};

/// Of the domains' means, within what the measure can be.
Standing standing_of(const Runs& runs, const TestedMeasure& measure) {
  const std::vector<double> means = means_by_domain(runs, measure.metric.key, measure.kind);
  Standing standing{means.size()};
  if (means.empty()) return standing;
  standing.mean = mean(means);
  standing.interval = interval_of_mean(means);
  const Interval range = range_of(measure.metric.key);
  if (standing.interval)
    standing.interval = {std::max(standing.interval->low, range.low),
                         std::min(standing.interval->high, range.high)};
  return standing;
}

/// What the pairs of a row say.
void add_pairs(const std::string& name, const std::string& key, const Inference& inference,
               Standing& standing) {
  std::map<std::string, std::set<int>> ways;  // by domain: above, below or like another row
  for (const PairComparison& pair : inference.pairs()) {
    if (pair.metric.key != key || (pair.first != name && pair.second != name)) continue;
    standing.is_compared = true;
    const bool is_first = pair.first == name;
    const int sign = is_first == (pair.metric.better == Better::kHigher) ? 1 : -1;
    const std::vector<double> means = pair.domains.means();
    for (std::size_t k = 0; k < means.size(); ++k)
      ways[pair.domains.names[k]].insert(sign * ((means[k] > 0) - (means[k] < 0)));
    if (inference.first_is_better(pair) == is_first)
      standing.beaten.push_back(is_first ? pair.second : pair.first);
  }
  for (const auto& [domain, all] : ways) {
    standing.won += all == std::set{1};
    standing.lost += all == std::set{-1};
  }
}

/// Rows are pipelines; of a single one the values of the axes that are compared.
class Summarising {
 public:
  Summarising(const StudyFile& study, const std::vector<CellRecord>& records, const Inference& inference)
      : inference_(inference),
        measures_(compared_measures(study, records)),
        of_axes_(study.pipelines.size() == 1 && !study.pairs.empty()) {
    std::set<std::string> domains;
    for (const CellRecord& record : records)
      if (record.reason.empty() && makes_quads(record)) domains.insert(domain_of(record));
    if (domains.size() < 2) return;
    if (!of_axes_) add_rows("", study.pipelines, records);
    for (const auto& [title, values] : study.axes)
      if (of_axes_ && std::ranges::find(study.pairs, title) != study.pairs.end())
        add_rows(title, values, records);
  }

  Table by_word(const std::string& title) const {
    Table table{title + ": summary", heading(), "kind", {{kDomains, "domains", 0}}, {}, notes()};
    table.shown = {kDomains};
    for (const auto& [metric, kind] : measures_) {
      table.columns.push_back({metric.key, metric.title, metric.digits});
      for (const char* end : {"low", "high"})
        table.columns.push_back({metric.key + "_" + end, metric.title + " " + end, metric.digits});
      for (const char* count : {"won", "lost"}) table.columns.push_back({metric.key + "_" + count, count, 0});
      for (const char* end : {"", "_won", "_lost"}) table.shown.push_back(metric.key + end);
    }
    table.columns.push_back({kBetterThan, "proven better than", 0});
    table.shown.emplace_back(kBetterThan);
    for (const Row& entry : rows_) {
      TableRow row{entry.name, entry.kind, {}, {}, "", ""};
      std::vector<std::string> better;
      for (const auto& [metric, kind] : measures_) {
        const Standing& standing = entry.standings.at(metric.key);
        row.values[kDomains] = std::fmax(value_or_nan(row.values, kDomains), double(standing.domains));
        add_values(entry, metric, metric.key, metric.key + "_", row);
        if (!standing.beaten.empty())
          better.push_back(fmt::format("{}: {}", metric.title, fmt::join(standing.beaten, ", ")));
      }
      row.texts[kBetterThan] = better.empty() ? "-" : fmt::format("{}", fmt::join(better, "; "));
      table.rows.push_back(std::move(row));
    }
    return table;
  }

  Table by_measure(const std::string& title) const {
    Table table{title + ": summary", "measure", heading(), {}, {}, notes()};
    table.columns = {{kDomains, "domains", 0},
                     {"mean", "mean", 0},
                     {"won", "won", 0},
                     {"lost", "lost", 0},
                     {kBetterThan, "proven better than", 0}};
    for (const auto& [metric, kind] : measures_)
      for (const Row& entry : rows_) {
        const Standing& standing = entry.standings.at(metric.key);
        if (standing.domains == 0) continue;
        TableRow row{metric.title, entry.name, {{kDomains, double(standing.domains)}}, {}, "", ""};
        add_values(entry, metric, "mean", "", row);
        row.texts[kBetterThan] =
            standing.beaten.empty() ? "-" : fmt::format("{}", fmt::join(standing.beaten, ", "));
        table.rows.push_back(std::move(row));
      }
    return table;
  }

 private:
  struct Row {
    std::string name;
    const char* kind;
    Runs runs;
    std::size_t rivals = 0;
    std::map<std::string, Standing> standings = {};  // by measure
  };

  const char* heading() const { return of_axes_ ? "value" : "pipeline"; }

  /// Of the pipelines, or the values of an axis, that have runs.
  void add_rows(const std::string& along, const std::vector<std::string>& values,
                const std::vector<CellRecord>& records) {
    std::vector<Row> rows;
    for (const std::string& value : values) {
      Row row{along.empty() ? value : along + "=" + value, along.empty() ? "word" : "option", {}};
      for (const CellRecord& record : records)
        if (record.reason.empty() && makes_quads(record) && value_along(record, along) == value) {
          row.runs.push_back(&record);
          if (along.empty() && record.is_peer) row.kind = "peer";
        }
      if (!row.runs.empty()) rows.push_back(std::move(row));
    }
    for (Row& row : rows) {
      row.rivals = rows.size() - 1;
      for (const TestedMeasure& measure : measures_) {
        Standing& standing = row.standings[measure.metric.key] = standing_of(row.runs, measure);
        add_pairs(row.name, measure.metric.key, inference_, standing);
        fewest_ = std::min(fewest_, standing.domains);
        most_ = std::max(most_, standing.domains);
      }
      rows_.push_back(std::move(row));
    }
  }

  void add_values(const Row& entry, const Metric& metric, const std::string& key, const std::string& prefix,
                  TableRow& row) const {
    const Standing& standing = entry.standings.at(metric.key);
    if (standing.domains == 0) return;
    row.values[key] = standing.mean;
    row.texts[key] = number_text(standing.mean, metric.digits);
    if (standing.interval) {
      row.values[prefix + "low"] = standing.interval->low;
      row.values[prefix + "high"] = standing.interval->high;
      row.texts[key] = interval_text(standing.mean, *standing.interval, metric.digits);
    }
    if (standing.is_compared) {
      row.values[prefix + "won"] = standing.won;
      row.values[prefix + "lost"] = standing.lost;
    }
    if (entry.rivals > 0 && standing.beaten.size() == entry.rivals) row.marks[key] = Mark::kBest;
  }

  std::vector<std::string> notes() const {
    if (rows_.empty()) return {};
    std::vector<std::string> notes = {
        "Means of the domains' (geometries') means over their variants and seeds, with 95 % intervals "
        "(bootstrap-t over domains, of fewer than six Student's).",
        "Won: domains on which it is better than every other one, by the mean difference of each pair "
        "there. Lost: those on which it is worse than every other. Ties are neither.",
        "Proven better than: at 5 %. Bold: than all others. " + inference_.family().note()};
    if (fewest_ < most_)
      notes.emplace_back(
          "Those with fewer domains have no value on the others: their means are over other domains.");
    return notes;
  }

  const Inference& inference_;
  std::vector<TestedMeasure> measures_;
  bool of_axes_;
  std::vector<Row> rows_;
  std::size_t fewest_ = std::numeric_limits<std::size_t>::max(), most_ = 0;
};

}  // namespace

Summary summarise(const StudyFile& study, const std::vector<CellRecord>& records,
                  const Inference& inference) {
  const Summarising summary(study, records, inference);
  return {summary.by_word(study.title), summary.by_measure(study.title)};
}

}  // namespace delquad
