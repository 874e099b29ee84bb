#include "program/print.h"

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "base/parallel.h"
#include "metrics/judgement/criteria.h"
#include "metrics/judgement/soundness.h"
#include "metrics/metric_measures.h"

namespace delquad {
namespace {

std::string show(const Topology& t) {
  return fmt::format("{}, Euler characteristic {}", t.watertight() ? "watertight" : "open",
                     t.euler_characteristic);
}

}  // namespace

void print_metric(const Metric& metric, const MeshMetrics& metrics) {
  const auto at = metrics.values.find(metric.key);
  const std::string value =
      at == metrics.values.end() || std::isnan(at->second) ? "-" : fmt::format("{:.6g}", at->second);
  fmt::print("  {:<10} {:>12} {}\n", metric.title, value, metric.unit);
}

void print_metrics(const MeshMetrics& metrics) {
  for (const Metric& metric : metric_registry()) print_metric(metric, metrics);
  for (const Metric& metric : metrics_by_metric())
    if (metrics.values.contains(metric.key)) print_metric(metric, metrics);
}

void print_criteria(const CriteriaReport& report, const Mesh& mesh) {
  const auto percent = [&](std::size_t n) {
    return 100 * static_cast<double>(n) / static_cast<double>(report.elements);
  };
  fmt::print("  criteria{}: {} of {} elements fail, {:.3g} %\n", report.name.empty() ? "" : " " + report.name,
             report.failing, report.elements, percent(static_cast<std::size_t>(report.failing)));
  for (const CriterionResult& r : report.results) {
    fmt::print("    {:<18} {:>13} {:>8} {:>7.3g} %  worst {:.4g}", r.limit.key, text_of(r.limit),
               r.failing.size(), percent(r.failing.size()), r.worst);
    if (!r.failing.empty()) fmt::print(" in {} ({})", show_place(mesh, r.at), r.cause);
    fmt::print("{}\n", r.limit.on.empty() ? "" : " on '" + r.limit.on + "'");
  }
  fmt::print("    time step: critical {:.4g}, {:.3g} of that of squares of the least size; estimated",
             report.critical_step, report.critical_step / report.step_of_squares);
  for (const auto& [program, step] : report.estimated_step) fmt::print(" {} {:.4g}", program, step);
  fmt::print("\n");
  for (const std::string& why : report.why) fmt::print("    {}\n", why);
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

void print_surface_report(const Prepared& prepared, const SurfaceReport& report) {
  const MapReport maps = prepared.maps();
  fmt::print(
      "maps: {} patches, ratio of singular values {:.4g} (mean), {:.4g} (95 %), {:.4g} (max), area scale "
      "{:.3g}",
      maps.patches.size(), maps.sigma_mean, maps.sigma_95, maps.sigma_max, maps.area_ratio);
  if (maps.worst_face >= 0 && maps.sigma_95 > 1.001)
    fmt::print("; worst: face {}", prepared->boundary.regions[maps.worst_face].tag);
  double length = 0;
  for (const SurfaceCut& cut : prepared.cuts()) length += cut.length;
  fmt::print("\ncuts: {}, together {:.4g} long", prepared.cuts().size(), length);
  const QuadShare &near = report.near_cuts, &off = report.off_cuts;
  if (near.quads > 0 && off.quads > 0)
    fmt::print("; eta {:.3f} and d4 {:.1f} near them, {:.3f} and {:.1f} elsewhere", near.eta, near.d4,
               off.eta, off.d4);
  fmt::print("\n");
  fmt::print("mesh: {}; the model is {}\n", show(report.mesh), show(report.model));
  fmt::print(
      "distances in diagonals (max, mean): mesh to surface {:.2g}, {:.2g}; surface to mesh {:.2g}, {:.2g}\n",
      report.mesh_to_surface.max, report.mesh_to_surface.mean, report.surface_to_mesh.max,
      report.surface_to_mesh.mean);
  fmt::print("nodes to surface (max): in faces {:.2g}, on curves {:.2g}, at corners {:.2g}\n",
             report.nodes_in_faces.max, report.nodes_on_curves.max, report.nodes_at_corners.max);
}

void print_tables(const Outcome& outcome) {
  fmt::print("{}\n", to_markdown(outcome.table));
  for (const Table* table : {&outcome.pairs, &outcome.hypotheses})
    if (!table->rows.empty()) fmt::print("{}\n", to_markdown(*table));
}

}  // namespace delquad
