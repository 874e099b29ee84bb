// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrics/tables/comparison.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "base/located.h"
#include "base/nearest_name.h"
#include "base/text.h"
#include "metrics/tables/samples.h"
#include "metrics/tables/table.h"

namespace delquad {
namespace {

constexpr const char* kTimeColumn = "seconds";
constexpr int kDigits = 4;

/// Returns the metric of a key, if one direction is better.
Metric comparable(const std::string& key, const std::vector<Metric>& own) {
  std::vector<Metric> metrics(metric_registry().begin(), metric_registry().end());
  metrics.insert(metrics.end(), own.begin(), own.end());
  metrics.push_back({kTimeColumn, "s", "s", Better::kLower, HUGE_VAL, ""});
  std::erase_if(metrics, [](const Metric& m) { return m.better == Better::kNeither; });
  if (const auto at = std::ranges::find(metrics, key, &Metric::key); at != metrics.end()) return *at;
  std::vector<std::string> known;
  for (const Metric& m : metrics)
    if (std::ranges::find(known, m.key) == known.end()) known.push_back(m.key);
  refuse("metric '{}' cannot be compared: expected some of {}{}", key, fmt::join(known, ", "),
         suggestion(key, known));
}

std::string name(const CellRecord& r) { return r.group + " " + r.pipeline; }

using Runs = std::vector<const CellRecord*>;

/// Cells that differ only in the seed, before and after, in the same order.
struct Row {
  std::string group, pipeline;
  Runs before, after;
};

std::string group_of(const CellRecord& r) {
  const bool has_seed = std::ranges::any_of(r.variant, [](const auto& v) { return v.first == "seed"; });
  return has_seed ? row_group(r) : r.group;
}

/// Pairs the cells of both runs, and lists the rest.
std::vector<Row> pair_cells(const std::vector<CellRecord>& before, const std::vector<CellRecord>& after,
                            Comparison& result) {
  std::map<std::string, const CellRecord*> later;
  for (const CellRecord& r : after) later[name(r)] = &r;
  std::vector<Row> rows;
  for (const CellRecord& a : before) {
    const auto at = later.find(name(a));
    if (at == later.end()) {
      result.missing.push_back(name(a));
      continue;
    }
    const CellRecord& b = *at->second;
    later.erase(at);
    if (!a.reason.empty() || !b.reason.empty()) {
      if (b.reason.empty())
        result.recovered.push_back(name(a));
      else
        (a.reason.empty() ? result.failed : result.failing).push_back(name(a) + ": " + b.reason);
      continue;
    }
    const std::string group = group_of(a);
    auto row = std::ranges::find_if(
        rows, [&](const Row& r) { return r.group == group && r.pipeline == a.pipeline; });
    if (row == rows.end()) row = rows.insert(rows.end(), {group, a.pipeline, {}, {}});
    row->before.push_back(&a);
    row->after.push_back(&b);
  }
  for (const CellRecord& r : after)
    if (later.contains(name(r))) result.added.push_back(name(r));
  return rows;
}

bool is_small(double change, double magnitude, double tolerance) {
  return std::abs(change) <= tolerance * magnitude;
}

MeasureChange change_of(const Row& row, const Metric& metric, double tolerance) {
  MeasureChange change{row.group, row.pipeline,       metric.key, std::nan(""), std::nan(""),
                       0,         Verdict::kUnchanged};
  std::vector<double> before, after;
  bool lost = false, found = false, up = false, down = false;
  for (std::size_t i = 0; i < row.before.size(); ++i) {
    const double a = value_of(*row.before[i], metric.key), b = value_of(*row.after[i], metric.key);
    lost = lost || (!std::isnan(a) && std::isnan(b));
    found = found || (std::isnan(a) && !std::isnan(b));
    if (std::isnan(a) || std::isnan(b)) continue;
    before.push_back(a);
    after.push_back(b);
    (b > a ? up : down) |= a != b;
  }
  change.runs = before.size();
  if (!before.empty()) {
    change.before = mean(before);
    change.after = mean(after);
  }
  if (lost || found)
    change.verdict = lost ? Verdict::kWorse : Verdict::kBetter;
  else if (before.empty() || is_small(change.after - change.before,
                                      std::max(std::abs(change.before), std::abs(change.after)), tolerance))
    return change;
  else if (metric.key == kTimeColumn || (up && down))
    change.verdict = Verdict::kNotProven;
  else
    change.verdict = up == (metric.better == Better::kHigher) ? Verdict::kBetter : Verdict::kWorse;
  return change;
}

double mean_magnitude(const Runs& runs, const std::string& key) {
  const std::vector<double> means = means_by_domain(runs, key);
  return means.empty() ? 0 : std::abs(mean(means));
}

/// Compares over domains; failed cells lose.
std::vector<DomainChange> compare_over_domains(const std::vector<CellRecord>& before,
                                               const std::vector<CellRecord>& after,
                                               const std::vector<Metric>& metrics, double tolerance,
                                               ClaimFamily& family) {
  std::vector<std::string> words;
  std::map<std::string, Runs> old, now;
  for (const auto& [records, runs] : {std::pair(&before, &old), std::pair(&after, &now)})
    for (const CellRecord& record : *records) {
      if (record.skipped) continue;
      if (runs == &old && !old.contains(record.pipeline)) words.push_back(record.pipeline);
      (*runs)[record.pipeline].push_back(&record);
    }
  std::vector<DomainChange> all;
  for (const std::string& word : words)
    for (const Metric& metric : metrics) {
      if (metric.key == kTimeColumn) continue;
      PairComparison pair{"after", "before", metric, pair_by_domain(now[word], old[word], metric, "", false)};
      if (pair.domains.names.size() < kFewestDomains) continue;
      pair.interval = interval_of_mean(pair.domains.finite());
      pair.test = family.add(wilcoxon(pair.domains.differences));
      all.push_back({word, std::move(pair), Verdict::kUnchanged});
    }
  family.decide();
  for (auto& [word, pair, verdict] : all) {
    const std::string& key = pair.metric.key;
    const double magnitude = std::max(mean_magnitude(old[word], key), mean_magnitude(now[word], key));
    if (!pair.domains.has_failures() && is_small(mean(pair.domains.differences), magnitude, tolerance))
      continue;
    const auto better = first_is_better(pair, family);
    verdict = !better ? Verdict::kNotProven : *better ? Verdict::kImproved : Verdict::kRegressed;
  }
  return all;
}

const char* text_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::kImproved:
      return "improved";
    case Verdict::kRegressed:
      return "regressed";
    default:
      return "changed";
  }
}

/// Returns the remark on a change, with the number of runs.
std::string remark(Verdict verdict, std::size_t runs, const std::string& failures = "") {
  std::string text = runs == 1 ? "one run" : fmt::format("{} runs", runs);
  if (!failures.empty()) text += "; " + failures;
  if (verdict == Verdict::kNotProven) return fmt::format("  (not proven; {})", text);
  if (verdict == Verdict::kBetter || verdict == Verdict::kWorse)
    return fmt::format("  ({}; {})", verdict == Verdict::kBetter ? "better" : "worse", text);
  return fmt::format("  ({})", text);
}

}  // namespace

int Comparison::count(Verdict verdict) const {
  return static_cast<int>(std::ranges::count(changes, verdict, &MeasureChange::verdict) +
                          std::ranges::count(over_domains, verdict, &DomainChange::verdict));
}

Comparison compare_records(const std::vector<CellRecord>& before, const std::vector<CellRecord>& after,
                           const std::vector<std::string>& metrics, double tolerance) {
  std::vector<Metric> own = added_metrics_of(before), requested_metrics;
  std::ranges::copy(added_metrics_of(after), std::back_inserter(own));
  for (const std::string& key : metrics) requested_metrics.push_back(comparable(key, own));

  Comparison result;
  for (const Row& row : pair_cells(before, after, result))
    for (const Metric& metric : requested_metrics)
      result.changes.push_back(change_of(row, metric, tolerance));
  ClaimFamily family;
  result.over_domains = compare_over_domains(before, after, requested_metrics, tolerance, family);
  if (family.size() > 0) result.note = family.note();
  return result;
}

std::string to_text(const Comparison& comparison) {
  std::string text;
  for (const auto& [pipeline, pair, verdict] : comparison.over_domains) {
    if (verdict == Verdict::kUnchanged) continue;
    const std::vector<double> finite = pair.domains.finite();
    text += fmt::format("{:<9}  {} over {} domains: {} {}{}\n", text_of(verdict), pipeline,
                        pair.domains.names.size(), pair.metric.key,
                        pair.interval ? interval_text(mean(finite), *pair.interval, kDigits) : "-",
                        remark(verdict, pair.domains.runs, pair.failures()));
  }
  for (const MeasureChange& c : comparison.changes)
    if (c.verdict != Verdict::kUnchanged)
      text += fmt::format("{:<9}  {} {}: {} {:.6g} -> {:.6g}{}\n", text_of(c.verdict), c.group, c.pipeline,
                          c.metric, c.before, c.after, remark(c.verdict, c.runs));
  const auto list = [&](const char* what, const std::vector<std::string>& cells) {
    for (const std::string& cell : cells) text += fmt::format("{:<9}  {}\n", what, cell);
  };
  list("missing", comparison.missing);
  list("failed", comparison.failed);
  list("failing", comparison.failing);
  list("recovered", comparison.recovered);
  list("added", comparison.added);
  const auto n = [&](Verdict verdict) { return comparison.count(verdict); };
  if (!comparison.note.empty()) text += comparison.note + "\n";
  text += fmt::format(
      "{}: {} improved, {} regressed; changed: {} better, {} worse, {} not proven; {} unchanged; {} missing, "
      "{} failed\n",
      counted(comparison.changes.size() + comparison.over_domains.size(), "measure"), n(Verdict::kImproved),
      n(Verdict::kRegressed), n(Verdict::kBetter), n(Verdict::kWorse), n(Verdict::kNotProven),
      n(Verdict::kUnchanged), counted(comparison.missing.size(), "cell"),
      counted(comparison.failed.size(), "cell"));
  return text;
}

}  // namespace delquad
