#include "sweep/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "delquad/error.h"
#include "metrics/metrics.h"

namespace delquad {
namespace {

/// +1 where more is better, -1 where less is.
int direction(const std::string& key, const std::vector<Metric>& own) {
  if (key == "seconds") return -1;
  std::vector<Metric> metrics(metric_registry().begin(), metric_registry().end());
  for (const Metric& metric : own)
    if (find_metric(metric.key) == nullptr) metrics.push_back(metric);
  const auto at = std::ranges::find(metrics, key, &Metric::key);
  if (at != metrics.end() && at->better != Better::kNeither) return at->better == Better::kHigher ? 1 : -1;
  std::string known;
  for (const Metric& m : metrics)
    if (m.better != Better::kNeither) known += m.key + ", ";
  throw InputError("metric '" + key + "' cannot be compared: expected some of " + known + "seconds");
}

Verdict judge(double before, double after, int direction, double tolerance) {
  if (std::isnan(before) || std::isnan(after)) {
    if (std::isnan(before) == std::isnan(after)) return Verdict::kUnchanged;
    return std::isnan(after) ? Verdict::kRegressed : Verdict::kImproved;
  }
  const double change = after - before;
  if (std::abs(change) <= tolerance * std::max(std::abs(before), std::abs(after))) return Verdict::kUnchanged;
  return change * direction > 0 ? Verdict::kImproved : Verdict::kRegressed;
}

std::string name(const CellRecord& r) { return r.group + " " + r.pipeline; }

std::string plural(size_t n, const char* what) { return fmt::format("{} {}{}", n, what, n == 1 ? "" : "s"); }

}  // namespace

int Comparison::count(Verdict verdict) const {
  return static_cast<int>(std::count_if(changes.begin(), changes.end(),
                                        [&](const MeasureChange& c) { return c.verdict == verdict; }));
}

Comparison compare_records(const std::vector<CellRecord>& before, const std::vector<CellRecord>& after,
                           const std::vector<std::string>& metrics, double tolerance) {
  std::vector<int> directions;
  std::vector<Metric> own = own_metrics_of(before);
  for (Metric& metric : own_metrics_of(after))
    if (std::ranges::find(own, metric.key, &Metric::key) == own.end()) own.push_back(std::move(metric));
  for (const std::string& metric : metrics) directions.push_back(direction(metric, own));
  std::map<std::string, const CellRecord*> later;
  for (const CellRecord& r : after) later[name(r)] = &r;

  Comparison result;
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
    for (size_t m = 0; m < metrics.size(); ++m) {
      const auto value = [&](const CellRecord& r) {
        const auto v = r.values.find(metrics[m]);
        return v == r.values.end() ? std::nan("") : v->second;
      };
      result.changes.push_back({a.group, a.pipeline, metrics[m], value(a), value(b),
                                judge(value(a), value(b), directions[m], tolerance)});
    }
  }
  for (const CellRecord& r : after)
    if (later.count(name(r))) result.added.push_back(name(r));
  return result;
}

std::string to_text(const Comparison& comparison) {
  std::string text;
  for (const MeasureChange& c : comparison.changes)
    if (c.verdict != Verdict::kUnchanged)
      text += fmt::format("{}  {} {}: {} {:.6g} -> {:.6g}\n",
                          c.verdict == Verdict::kImproved ? "improved " : "regressed", c.group, c.pipeline,
                          c.metric, c.before, c.after);
  const auto list = [&](const char* what, const std::vector<std::string>& cells) {
    for (const std::string& cell : cells) text += fmt::format("{:<9}  {}\n", what, cell);
  };
  list("missing", comparison.missing);
  list("failed", comparison.failed);
  list("failing", comparison.failing);
  list("recovered", comparison.recovered);
  list("added", comparison.added);
  text += fmt::format("{}: {} improved, {} regressed, {} unchanged; {} missing, {} failed\n",
                      plural(comparison.changes.size(), "measure"), comparison.count(Verdict::kImproved),
                      comparison.count(Verdict::kRegressed), comparison.count(Verdict::kUnchanged),
                      plural(comparison.missing.size(), "cell"), plural(comparison.failed.size(), "cell"));
  return text;
}

}  // namespace delquad
