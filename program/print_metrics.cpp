#include "program/print_metrics.h"

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

void print_seconds(const StepTimes& times) {
  std::string work, clock;
  TimeSpent all;
  for (const auto& [step, time] : times) {
    const char* comma = work.empty() ? "" : ", ";
    work += fmt::format("{}{} {:.2f}", comma, step, time.work);
    clock += fmt::format("{}{} {:.2f} ({:.2f})", comma, step, time.clock, time.alone);
    all = all + time;
  }
  const int threads = thread_count();
  fmt::print("  seconds: {}; all {:.2f}{}\n", work, all.work,
             threads > 1 ? fmt::format(" (of {} threads, added up)", threads) : "");
  if (threads > 1)
    fmt::print("  on the clock (while one thread worked alone): {}; all {:.2f} ({:.2f})\n", clock, all.clock,
               all.alone);
}

}  // namespace delquad
