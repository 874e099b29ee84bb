#include "metrics/tables/pairs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "metrics/tables/cell_text.h"

namespace delquad {
namespace {

using Runs = std::vector<const CellRecord*>;

bool all_quads(const Runs& runs) {
  return std::ranges::none_of(runs, [](const CellRecord* r) { return leaves_triangles(*r); });
}

/// Whether the first is proven to be better; not where the mean and most of the ranks disagree.
std::optional<bool> first_is_better(const PairComparison& pair, const ClaimFamily& family) {
  const double effect = mean(pair.domains.means());
  const double lean = family.test(pair.test).lean;
  if (family.finding(pair.test) != Finding::kProven || effect * lean <= 0) return std::nullopt;
  return (effect > 0) == (pair.metric.better == Better::kHigher);
}

std::string in_words(const PairComparison& pair, const ClaimFamily& family) {
  if (pair.domains.names.size() < kFewestDomains || family.finding(pair.test) == Finding::kTooFew)
    return "too few domains";
  const auto better = first_is_better(pair, family);
  return !better ? "not proven" : *better ? "better" : "worse";
}

TableRow row_of(const PairComparison& pair, const ClaimFamily& family) {
  const std::vector<double> means = pair.domains.means();
  const double sign = pair.metric.better == Better::kHigher ? 1 : -1, effect = mean(means);
  const auto count = [&](double side) {
    return static_cast<double>(std::ranges::count_if(means, [&](double d) { return side * sign * d > 0; }));
  };
  TableRow row{pair.first + " - " + pair.second, pair.metric.title, {}, {}, "", ""};
  row.values = {{"domains", static_cast<double>(means.size())},
                {"runs", static_cast<double>(pair.domains.runs)},
                {"better", count(1)},
                {"worse", count(-1)},
                {"effect", effect},
                {"p", family.test(pair.test).p},
                {"p_corrected", family.adjusted_p(pair.test)}};
  const auto interval = bootstrap_interval(pair.domains.differences);
  if (interval) {
    row.values["low"] = interval->low;
    row.values["high"] = interval->high;
    row.texts["effect"] = interval_text(effect, *interval, pair.metric.digits);
  }
  for (const char* key : {"p", "p_corrected"})
    if (!std::isnan(row.values[key])) row.texts[key] = p_text(row.values[key]);
  row.texts["first_is"] = in_words(pair, family);
  if (first_is_better(pair, family)) row.marks["effect"] = Mark::kBest;
  return row;
}

}  // namespace

std::vector<PairComparison> compare_pairs(const std::vector<CellRecord>& records,
                                          const std::vector<std::string>& pipelines,
                                          const std::vector<TestedMeasure>& measures, ClaimFamily& family) {
  std::map<std::string, Runs> by_word;
  for (const CellRecord& record : records)
    if (record.reason.empty() && makes_quads(record)) by_word[record.pipeline].push_back(&record);
  std::vector<PairComparison> pairs;
  for (std::size_t i = 0; i < pipelines.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const Runs &a = by_word[pipelines[i]], &b = by_word[pipelines[j]];
      for (const auto& [metric, kind] : measures) {
        if (is_of_quads(metric.key) && !(all_quads(a) && all_quads(b))) continue;
        PairedDomains domains = pair_by_domain(a, b, metric.key, kind);
        if (domains.names.size() < 2) continue;
        const std::size_t test = family.add(wilcoxon(domains.means()));
        pairs.push_back({pipelines[i], pipelines[j], metric, std::move(domains), test});
      }
    }
  return pairs;
}

Table pairs_table(const std::string& title, const std::vector<PairComparison>& pairs,
                  const ClaimFamily& family) {
  Table table{title + ": pairs of pipelines", "pipelines", "measure", {}, {}, {}};
  table.columns = {{"domains", "domains", 0},
                   {"runs", "runs", 0},
                   {"better", "better", 0},
                   {"worse", "worse", 0},
                   {"effect", "difference", 4},
                   {"low", "low", 4},
                   {"high", "high", 4},
                   {"p", "p", 4},
                   {"p_corrected", "p corrected", 4},
                   {"first_is", "first is", 0}};
  table.shown = {"domains", "runs", "better", "worse", "effect", "p", "p_corrected", "first_is"};
  const auto has_few = [](const PairComparison& pair) { return pair.domains.names.size() < kFewestDomains; };
  for (const PairComparison& pair : pairs) table.rows.push_back(row_of(pair, family));
  if (pairs.empty()) return table;
  table.notes = {
      "First minus second, averaged over the seeds and variants of each domain (case); domains are the "
      "sample. Better, worse: on how many of them the first is. Difference: the mean of the domains, "
      "with its 95 % bootstrap interval (percentiles of 2000 resamples of domains, then seeds).",
      "p: Wilcoxon's signed-rank test over the domains, two-sided." +
          (std::ranges::all_of(pairs, has_few) ? "" : " " + family.note())};
  if (std::ranges::any_of(pairs, has_few))
    table.notes.push_back(fmt::format("With fewer than {} domains nothing can be proven.", kFewestDomains));
  return table;
}

}  // namespace delquad
