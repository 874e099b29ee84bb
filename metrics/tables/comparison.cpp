#include "metrics/tables/comparison.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "base/located.h"
#include "base/nearest_name.h"
#include "base/text.h"
#include "metrics/metrics.h"
#include "metrics/tables/inference.h"
#include "metrics/tables/samples.h"
#include "metrics/tables/table.h"

namespace delquad {
namespace {

constexpr const char* kTimeColumn = "seconds";
constexpr int kDigits = 4;

/// +1 where more is better, -1 where less is.
int direction(const std::string& key, const std::vector<Metric>& own) {
  if (key == kTimeColumn) return -1;
  std::vector<Metric> metrics(metric_registry().begin(), metric_registry().end());
  for (const Metric& metric : own)
    if (find_metric(metric.key) == nullptr) metrics.push_back(metric);
  const auto at = std::ranges::find(metrics, key, &Metric::key);
  if (at != metrics.end() && at->better != Better::kNeither) return at->better == Better::kHigher ? 1 : -1;
  std::vector<std::string> known;
  for (const Metric& m : metrics)
    if (m.better != Better::kNeither) known.push_back(m.key);
  known.emplace_back(kTimeColumn);
  refuse("metric '{}' cannot be compared: expected some of {}{}", key, fmt::join(known, ", "),
         suggestion(key, known));
}

std::string name(const CellRecord& r) { return r.group + " " + r.pipeline; }

using Runs = std::vector<const CellRecord*>;

/// Cells that differ in the seed alone, before and after, in the same order.
struct Row {
  std::string group, pipeline;
  Runs before, after;
};

std::string group_of(const CellRecord& r) {
  const bool has_seed = std::ranges::any_of(r.variant, [](const auto& v) { return v.first == "seed"; });
  return has_seed ? row_group(r) : r.group;
}

/// Sorts cells into those that both runs have and the rest.
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

bool is_small(double before, double after, double tolerance) {
  return std::abs(after - before) <= tolerance * std::max(std::abs(before), std::abs(after));
}

/// What a change that is not small means. `test`: its number in the family; none: single runs.
Verdict judge(double better_by, std::optional<std::size_t> test, int direction, const ClaimFamily& family) {
  if (!test || family.finding(*test) == Finding::kTooFew)
    return better_by > 0 ? Verdict::kBetter : Verdict::kWorse;
  if (family.finding(*test) != Finding::kProven || family.test(*test).lean * direction * better_by <= 0)
    return Verdict::kNotProven;
  return better_by > 0 ? Verdict::kImproved : Verdict::kRegressed;
}

std::vector<double> times_of(const Runs& runs) {
  std::vector<double> all;
  for (const CellRecord* run : runs)
    if (const auto at = run->times.find(kTimeColumn); at != run->times.end())
      all.insert(all.end(), at->second.begin(), at->second.end());
  return all;
}

/// One measure of one row, on its way to a verdict.
class RowChange {
 public:
  RowChange(const Row& row, std::string metric, int direction, ClaimFamily& family)
      : change_{row.group, row.pipeline,       std::move(metric), std::nan(""), std::nan(""),
                0,         Verdict::kUnchanged},
        direction_(direction) {
    if (change_.metric == kTimeColumn)
      add_times(row, family);
    else
      add_values(row, family);
  }

  MeasureChange judged(const ClaimFamily& family, double tolerance) const {
    MeasureChange change = change_;
    if (lost_ || found_) {
      change.verdict = lost_ ? Verdict::kWorse : Verdict::kBetter;
    } else if (!std::isnan(change.before) && !is_small(change.before, change.after, tolerance)) {
      const bool is_single_time = change.metric == kTimeColumn && !test_;
      change.verdict = is_single_time
                           ? Verdict::kNotProven
                           : judge((change.after - change.before) * direction_, test_, direction_, family);
    }
    return change;
  }

 private:
  void add_values(const Row& row, ClaimFamily& family) {
    std::vector<double> before, after, differences;
    for (std::size_t i = 0; i < row.before.size(); ++i) {
      const double a = value_of(*row.before[i], change_.metric), b = value_of(*row.after[i], change_.metric);
      lost_ = lost_ || (!std::isnan(a) && std::isnan(b));
      found_ = found_ || (std::isnan(a) && !std::isnan(b));
      if (std::isnan(a) || std::isnan(b)) continue;
      before.push_back(a);
      after.push_back(b);
      differences.push_back(b - a);
    }
    set(before, after);
    if (differences.size() > 1) test_ = family.add(wilcoxon(differences));
  }

  void add_times(const Row& row, ClaimFamily& family) {
    const std::vector<double> before = times_of(row.before), after = times_of(row.after);
    if (before.empty() || after.empty()) {
      add_single_times(row);
      return;
    }
    change_.before = median(before);
    change_.after = median(after);
    change_.runs = std::min(before.size(), after.size());
    test_ = family.add(mann_whitney(after, before));
  }

  void add_single_times(const Row& row) {
    std::vector<double> before, after;
    for (std::size_t i = 0; i < row.before.size(); ++i) {
      const double a = value_of(*row.before[i], kTimeColumn), b = value_of(*row.after[i], kTimeColumn);
      if (std::isnan(a) || std::isnan(b)) continue;
      before.push_back(a);
      after.push_back(b);
    }
    set(before, after);
  }

  void set(const std::vector<double>& before, const std::vector<double>& after) {
    change_.runs = before.size();
    if (before.empty()) return;
    change_.before = mean(before);
    change_.after = mean(after);
  }

  MeasureChange change_;
  int direction_;
  bool lost_ = false, found_ = false;  ///< values that are no longer defined, or now are
  std::optional<std::size_t> test_;
};

/// One measure of one pipeline over all domains, on its way to a verdict.
struct OverDomains {
  std::string pipeline, metric;
  PairedDomains domains;  ///< after minus before
  double magnitude;       ///< the larger mean of both
  int direction;
  std::size_t test;

  DomainChange judged(const ClaimFamily& family, double tolerance) const {
    const double change = mean(domains.means());
    Verdict verdict = Verdict::kUnchanged;
    if (std::abs(change) > tolerance * magnitude) {
      verdict = judge(change * direction, test, direction, family);
      // What is too little to prove over domains is told of its rows.
      if (verdict == Verdict::kBetter || verdict == Verdict::kWorse) verdict = Verdict::kNotProven;
    }
    return {pipeline, metric, domains.names.size(), domains.runs, change, interval_of_mean(domains.means()),
            verdict};
  }
};

double mean_magnitude(const Runs& runs, const std::string& key) {
  std::vector<double> values;
  for (const CellRecord* run : runs)
    if (const double v = value_of(*run, key); !std::isnan(v)) values.push_back(v);
  return values.empty() ? 0 : std::abs(mean(values));
}

std::vector<OverDomains> compare_over_domains(const std::vector<Row>& rows,
                                              const std::vector<std::string>& metrics,
                                              const std::vector<int>& directions, ClaimFamily& family) {
  std::vector<std::string> words;
  std::map<std::string, std::pair<Runs, Runs>> by_word;
  for (const Row& row : rows) {
    if (!by_word.contains(row.pipeline)) words.push_back(row.pipeline);
    auto& [before, after] = by_word[row.pipeline];
    before.insert(before.end(), row.before.begin(), row.before.end());
    after.insert(after.end(), row.after.begin(), row.after.end());
  }
  std::vector<OverDomains> result;
  for (const std::string& word : words)
    for (std::size_t m = 0; m < metrics.size(); ++m) {
      const auto& [before, after] = by_word[word];
      const ValueKind kind = metrics[m] == kTimeColumn ? ValueKind::kRepeatedTime : ValueKind::kMeasure;
      PairedDomains domains = pair_by_domain(after, before, metrics[m], kind);
      if (domains.names.size() < kFewestDomains) continue;
      const std::size_t test = family.add(wilcoxon(domains.means()));
      const double magnitude =
          std::max(mean_magnitude(before, metrics[m]), mean_magnitude(after, metrics[m]));
      result.push_back({word, metrics[m], std::move(domains), magnitude, directions[m], test});
    }
  return result;
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

/// What stands behind a change that is not proven, and of how many runs it is.
std::string remark(Verdict verdict, std::size_t runs) {
  const std::string n = runs == 1 ? "one run" : fmt::format("{} runs", runs);
  if (verdict == Verdict::kNotProven) return fmt::format("  (not proven; {})", n);
  if (verdict == Verdict::kBetter || verdict == Verdict::kWorse)
    return fmt::format("  ({}; {}, too few to prove anything)",
                       verdict == Verdict::kBetter ? "better" : "worse", n);
  return fmt::format("  ({})", n);
}

}  // namespace

int Comparison::count(Verdict verdict) const {
  return static_cast<int>(std::ranges::count(changes, verdict, &MeasureChange::verdict) +
                          std::ranges::count(over_domains, verdict, &DomainChange::verdict));
}

Comparison compare_records(const std::vector<CellRecord>& before, const std::vector<CellRecord>& after,
                           const std::vector<std::string>& metrics, double tolerance) {
  std::vector<int> directions;
  std::vector<Metric> own = own_metrics_of(before);
  for (Metric& metric : own_metrics_of(after))
    if (std::ranges::find(own, metric.key, &Metric::key) == own.end()) own.push_back(std::move(metric));
  for (const std::string& metric : metrics) directions.push_back(direction(metric, own));

  Comparison result;
  const std::vector<Row> rows = pair_cells(before, after, result);
  ClaimFamily family;
  std::vector<RowChange> changes;
  for (const Row& row : rows)
    for (std::size_t m = 0; m < metrics.size(); ++m)
      changes.emplace_back(row, metrics[m], directions[m], family);
  const std::vector<OverDomains> over_domains = compare_over_domains(rows, metrics, directions, family);
  family.decide();
  for (const RowChange& change : changes) result.changes.push_back(change.judged(family, tolerance));
  for (const OverDomains& change : over_domains)
    result.over_domains.push_back(change.judged(family, tolerance));
  if (family.size() > 0) result.note = family.note();
  return result;
}

std::string to_text(const Comparison& comparison) {
  std::string text;
  for (const DomainChange& c : comparison.over_domains)
    if (c.verdict != Verdict::kUnchanged)
      text += fmt::format("{:<9}  {} over {} domains: {} {}{}\n", text_of(c.verdict), c.pipeline, c.domains,
                          c.metric, interval_text(c.change, *c.interval, kDigits), remark(c.verdict, c.runs));
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
