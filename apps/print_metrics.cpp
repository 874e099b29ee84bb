#include "apps/print_metrics.h"

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "base/parallel.h"

namespace delquad {

void print_metric(const Metric& metric, const MeshMetrics& metrics) {
  const auto at = metrics.values.find(metric.key);
  const std::string value =
      at == metrics.values.end() || std::isnan(at->second) ? "-" : fmt::format("{:.6g}", at->second);
  fmt::print("  {:<10} {:>12} {}\n", metric.title, value, metric.unit);
}

void print_metrics(const MeshMetrics& metrics) {
  for (const Metric& metric : metric_registry()) print_metric(metric, metrics);
}

void print_seconds(const PreparedProblem& prepared, const StageLog& log) {
  auto seconds = prepared.seconds;
  seconds.insert(seconds.end(), log.seconds.begin(), log.seconds.end());
  std::string list;
  double sum = 0;
  for (const auto& [step, s] : seconds) {
    list += fmt::format("{}{} {:.2f}", list.empty() ? "" : ", ", step, s);
    sum += s;
  }
  fmt::print("  seconds: {}; all {:.2f}{}\n", list, sum,
             thread_count() > 1 ? fmt::format(" (of {} threads, added up)", thread_count()) : "");
}

}  // namespace delquad
