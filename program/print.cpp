// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/print.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "base/text.h"
#include "experiments/console/progress.h"
#include "geometry/mesh/cell_shapes.h"
#include "metrics/anisotropic_measures.h"
#include "metrics/judgement/criteria.h"
#include "metrics/judgement/soundness.h"

namespace delquad {
namespace {

std::string show(const Topology& t) {
  return fmt::format("{}, Euler characteristic {}", t.watertight() ? "watertight" : "open",
                     t.euler_characteristic);
}

/// A measure in a line of the summary: a comma stands before it, unless `before` begins with a blank.
/// `of_flaws`: a count that is told where there are any.
struct Shown {
  const char* key;
  const char* before;
  int digits;
  const char* behind = "";
  bool of_flaws = false;
};

void print_line(const char* title, const MeshMetrics& metrics, std::initializer_list<Shown> measures) {
  std::string line;
  for (const Shown& shown : measures) {
    const auto at = metrics.values.find(shown.key);
    if (at == metrics.values.end() || !std::isfinite(at->second) || (shown.of_flaws && at->second == 0))
      continue;
    line += fmt::format("{}{}{:.{}f}{}", line.empty() || shown.before[0] == ' ' ? "" : ", ", shown.before,
                        at->second, shown.digits, shown.behind);
  }
  if (!line.empty()) fmt::print("  {}: {}\n", title, line);
}

/// "steel (2), 'inlet'": names in the order in which they come, with the number of parts that have them where
/// it is above one.
std::string names_of(const std::vector<const Entity*>& entities) {
  std::vector<std::pair<std::string, int>> counts;
  for (const Entity* entity : entities)
    for (const std::string& name : entity->names) {
      const auto at = std::ranges::find(counts, name, &std::pair<std::string, int>::first);
      if (at == counts.end())
        counts.emplace_back(name, 1);
      else
        ++at->second;
    }
  std::vector<std::string> texts;
  for (const auto& [name, count] : counts)
    texts.push_back(count > 1 ? fmt::format("{} ({})", name, count) : name);
  constexpr std::size_t kMostNames = 8;
  return first_of(texts, kMostNames);
}

}  // namespace

void print_summary(const MeshMetrics& metrics) {
  print_line("shape", metrics,
             {{"eta_mean", "eta mean ", 3},
              {"eta_worst", "worst ", 3},
              {"scaled_jacobian_mean", "scaled Jacobian mean ", 3},
              {"scaled_jacobian_min", "least ", 3},
              {"angle_min", "angles from ", 1},
              {"angle_max", " to ", 1, " degrees"},
              {"aspect_mean", "aspect mean ", 2},
              {"aspect_max", "largest ", 2},
              {"n_inverted", "", 0, " inverted", true},
              {"n_folded", "", 0, " folded", true}});
  print_line("size", metrics,
             {{"tau", "tau ", 1, " %"},
              {"edge_min", "edges from ", 3},
              {"edge_max", " to ", 3, " sizes"},
              {"n_short", "", 0, " edges far too short", true}});
  print_line("in the metric", metrics,
             {{"metric_eta_mean", "eta mean ", 3},
              {"metric_eta_worst", "worst ", 3},
              {"metric_tau", "tau ", 1, " %"}});
  print_line("vertices", metrics,
             {{"d4", "d4 ", 1, " %"},
              {"n_irregular", "", 0, " irregular"},
              {"n_irregular_on_curves", "", 0, " of them on curves"}});
  print_line("charges of vertices, also on the boundary", metrics,
             {{"n_necessary", "", 0, " necessary"}, {"n_beyond", "", 0, " more"}});
}

void print_measures(const MeshMetrics& metrics) {
  (verbosity() == Verbosity::kAll ? print_metrics : print_summary)(metrics);
}

std::string show_counts(const Mesh& mesh) {
  std::string solids;
  for_each_shape(mesh, [&](const SolidShape& shape, const auto& cells, const auto&) {
    if (!cells.empty()) solids += fmt::format("{} {}, ", cells.size(), shape.plural);
  });
  return fmt::format("{}{} quads, {} triangles, {} {}", solids, mesh.quads.size(), mesh.triangles.size(),
                     mesh.points.size(), mesh.order > 1 ? "nodes" : "vertices");
}

void print_names(const Mesh& mesh) {
  const auto with_elements = [](const std::vector<Entity>& entities, const auto&... entity_of) {
    std::vector<char> has_some(entities.size(), 0);
    for (const std::vector<int>* all : {&entity_of...})
      for (const int entity : *all) has_some[entity] = 1;
    std::vector<const Entity*> found;
    for (std::size_t i = 0; i < entities.size(); ++i)
      if (has_some[i]) found.push_back(&entities[i]);
    return found;
  };
  const auto regions = with_elements(mesh.regions, mesh.triangle_region, mesh.quad_region);
  const auto curves = with_elements(mesh.curves, mesh.line_curve);
  std::vector<const Entity*> points;
  for (const NamedPoint& point : mesh.named_points) points.push_back(&point.entity);
  std::string line;
  for (const auto& [what, entities] : {std::pair("regions", regions), {"curves", curves}, {"points", points}})
    if (const std::string names = names_of(entities); !names.empty())
      line += fmt::format("{}{} {}", line.empty() ? "" : "; ", what, names);
  if (!line.empty()) fmt::print("  names: {}\n", line);
}

void print_surface_summary(const SurfaceReport& report) {
  fmt::print("  surface: {}; the mesh lies within {:.2g} diagonals of the model, the model within {:.2g}\n",
             report.mesh.watertight() ? "watertight" : "open", report.mesh_to_surface.max,
             report.surface_to_mesh.max);
}

void print_metric(const Metric& metric, const MeshMetrics& metrics) {
  const auto at = metrics.values.find(metric.key);
  const std::string value =
      at == metrics.values.end() || std::isnan(at->second) ? "-" : fmt::format("{:.6g}", at->second);
  fmt::print("  {:<10} {:>12} {}\n", metric.title, value, metric.unit);
}

void print_metrics(const MeshMetrics& metrics) {
  for (const Metric& metric : metric_registry()) print_metric(metric, metrics);
  for (const Metric& metric : anisotropic_measures())
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
  fmt::print(
      "    time step: critical {:.4g} (a length unless the sheet has a material), {:.3g} times the step of "
      "squares of the least size; estimated",
      report.critical_step, report.critical_step / report.step_of_squares);
  for (const auto& [program, step] : report.estimated_step) fmt::print(" {} {:.4g}", program, step);
  fmt::print("\n");
  for (const std::string& why : report.why) fmt::print("    {}\n", why);
  for (const Cure& cure : cures_by_key(report))
    fmt::print("    {} {:.3g} may cure {} of {} ({}), by estimate\n",
               cure.key == "size" ? "a --size there of" : "--ignore-below", cure.value, cure.count,
               report.failing, cure.cause);
}

std::vector<Cure> cures_by_key(const CriteriaReport& report) {
  std::vector<Cure> cures;
  for (const Cure& cure : report.cures) {
    const auto at = std::ranges::find(cures, cure.key, &Cure::key);
    if (at == cures.end()) {
      cures.push_back(cure);
      continue;
    }
    at->cause += ", " + cure.cause, at->count += cure.count;
    at->value = cure.key == "size" ? std::min(at->value, cure.value) : std::max(at->value, cure.value);
  }
  return cures;
}

void print_seconds(const StepTimes& times) {
  std::string each;
  double all = 0;
  for (const auto& [step, time] : times) {
    each += fmt::format("{}{} {:.2f}", each.empty() ? "" : ", ", step, time.seconds);
    all += time.seconds;
  }
  fmt::print("  seconds: {}; all {:.2f}{}\n", each, all,
             thread_count() > 1 ? " (of patches side by side, added up)" : "");
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
