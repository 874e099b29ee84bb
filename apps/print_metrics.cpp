#include "apps/print_metrics.h"

#include <fmt/format.h>

#include <cmath>

namespace delquad {

void print_metrics(const MeshMetrics& metrics) {
  for (const Metric& metric : metric_registry()) {
    const auto at = metrics.values.find(metric.key);
    const std::string value =
        at == metrics.values.end() || std::isnan(at->second) ? "-" : fmt::format("{:.6g}", at->second);
    fmt::print("  {:<10} {:>12} {}\n", metric.title, value, metric.unit);
  }
}

}  // namespace delquad
