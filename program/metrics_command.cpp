// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>
#include <optional>
#include <tuple>

#include "delquad/error.h"
#include "experiments/sweep/record.h"
#include "geometry/mesh/cell_shapes.h"
#include "geometry/mesh/check_mesh.h"
#include "geometry/mesh/outline.h"
#include "geometry/mesh/weld.h"
#include "io/cases/read_problem.h"
#include "io/mesh_io.h"
#include "metrics/cells.h"
#include "metrics/flow_links.h"
#include "metrics/judgement/criteria.h"
#include "metrics/judgement/soundness.h"
#include "metrics/solve/solver_metrics.h"
#include "program/commands.h"
#include "program/options.h"
#include "program/print.h"

namespace delquad {
namespace {

struct MetricsArguments {
  std::vector<std::string> solvers = {};  ///< that are to measure it, too
  std::filesystem::path mesh, json;
  std::optional<std::string> size;
  std::string criteria;  ///< a preset or file; empty: none
  bool strict = false;
  bool links = false;  ///< fields of flow, too
};

void add_solver(const Mesh& mesh, const std::string& solver, MeshMetrics& metrics) {
  SolverOutcome outcome = measure_by_solver(mesh, solver);
  metrics.values.merge(outcome.values);
  if (!outcome.undefined.empty()) metrics.failures[solver] = outcome.undefined;
}

/// The metrics of curved elements, which are no others' and stand in no table.
constexpr const char *kOrder = "order", *kLeastProven = "proven_jacobian_min",
                     *kMeanProven = "proven_jacobian_mean", *kUnproven = "n_unproven";

void add_curved(const Mesh& mesh, MeshMetrics& metrics) {
  const ProvenJacobians proven = proven_jacobians(mesh);
  metrics.values[kOrder] = mesh.order;
  metrics.values[kLeastProven] = proven.least;
  metrics.values[kMeanProven] = proven.mean;
  metrics.values[kUnproven] = proven.unproven;
}

void print_curved(const MeshMetrics& metrics) {
  for (const auto& [key, title, what] :
       {std::tuple{kOrder, "order", "of the elements; what stands above is of their corners"},
        {kLeastProven, "scaled J", "least proven"},
        {kMeanProven, "scaled J", "mean proven"},
        {kUnproven, "unproven", "elements: not proven to be positive"}})
    fmt::print("  {:<10} {:>12.6g} {}\n", title, metrics.values.at(key), what);
}

/// The metrics of links of flow, for who asks.
FlowLinks add_links(const Mesh& mesh, MeshMetrics& metrics) {
  const FlowLinks links = measure_flow_links(mesh);
  metrics.values["n_links"] = links.links;
  metrics.values["link_cos_max"] = links.cos_max;
  metrics.values["link_cos_mean"] = links.cos_mean;
  metrics.values["n_oblique_links"] = links.oblique;
  metrics.values["n_orthogonal_links"] = links.orthogonal;
  metrics.values["n_small_links"] = links.small;
  metrics.values["link_ratio_min"] = links.least_ratio;
  return links;
}

void print_links(const FlowLinks& links, const Mesh& mesh) {
  fmt::print("  links of flow: {}\n", links.links);
  if (links.links == 0) return;
  fmt::print(
      "    |cos| of link and edge: mean {:.4g}, largest {:.4g}{}; below 0.01: {:.1f} %, above 0.5: {}\n",
      links.cos_mean, links.cos_max, links.cos_max > 0 ? " (" + show_place(mesh, links.worst) + ")" : "",
      100.0 * links.orthogonal / links.links, links.oblique);
  fmt::print("    length over the mean size of both elements: least {:.4g} ({}); small, below 0.1: {}\n",
             links.least_ratio, show_place(mesh, links.shortest), links.small);
}

void print_solver(const MeshMetrics& metrics, const std::string& solver) {
  for (const Metric& metric : metrics_of_solver(solver)) print_metric(metric, metrics);
  if (const auto at = metrics.failures.find(solver); at != metrics.failures.end())
    fmt::print(stderr, "warning: no '{}': {}\n", solver, at->second);
}

/// Measures of cells, for which there are no criteria, sizes and solvers here.
int measure_cells(const MetricsArguments& arguments, const Mesh& mesh) {
  if (arguments.size || arguments.links || !arguments.criteria.empty() || !arguments.solvers.empty())
    require_straight(mesh, arguments.mesh.string() + ": --size, --criteria, --links or --solve");
  const CellMeasures measures = measure(mesh);
  const std::vector<std::string> defects = defects_of_cells(mesh);
  if (!arguments.json.empty())
    write_text_file(arguments.json, cells_record(arguments.mesh.string(), mesh, measures, defects));
  fmt::print("{}\n", arguments.mesh.string());
  print_cells(mesh, measures, defects);
  return kDone;
}

int metrics_command(const MetricsArguments& arguments) {
  check_distinct({{"the mesh", arguments.mesh}, {"--json", arguments.json}});
  if (!arguments.json.empty()) check_output(arguments.json);
  Criteria criteria;
  if (!arguments.criteria.empty()) criteria = read_criteria(arguments.criteria);
  if (arguments.strict && criteria.empty())
    throw InputError("--strict: there are no criteria: expected --criteria, too");
  criteria.strict |= arguments.strict;
  ReadNotes notes;
  const Mesh mesh = read_mesh(arguments.mesh, &notes);
  if (std::string torn = describe_unjoined(mesh); !torn.empty()) notes.push_back(std::move(torn));
  for (const std::string& note : notes) fmt::print(stderr, "note: {}\n", note);
  if (is_solid(mesh)) return measure_cells(arguments, mesh);
  if (mesh.triangles.empty() && mesh.quads.empty())
    throw InputError(arguments.mesh.string() + ": holds no triangles and no quads: expected some to measure");
  std::shared_ptr<const SizeField> size;
  if (arguments.size) size = size_of_mesh(mesh, *arguments.size);
  MeshMetrics metrics = evaluate_metrics(mesh, size.get());
  if (!arguments.solvers.empty() || arguments.links) require_straight(mesh, arguments.mesh.string());
  if (arguments.links && holds_surface(mesh))
    throw InputError(arguments.mesh.string() +
                     ": --links is for planar meshes: this is a surface in space [planar-format]");
  if (mesh.order > 1) add_curved(mesh, metrics);
  for (const std::string& solver : arguments.solvers) add_solver(mesh, solver, metrics);
  FlowLinks links;
  if (arguments.links) links = add_links(mesh, metrics);
  std::optional<CriteriaReport> report;
  if (!arguments.criteria.empty()) {
    report = judge(mesh, criteria, size.get());
    metrics.values.merge(values_of(*report));
  }
  if (!arguments.json.empty())
    write_text_file(arguments.json, metrics_record(arguments.mesh.string(), mesh, arguments.size.value_or(""),
                                                   metrics, report ? &*report : nullptr));
  fmt::print("{}\n", arguments.mesh.string());
  print_metrics(metrics);
  if (mesh.order > 1) print_curved(metrics);
  for (const std::string& solver : arguments.solvers) print_solver(metrics, solver);
  if (arguments.links) print_links(links, mesh);
  if (report) print_criteria(*report, mesh);
  if (!report || !criteria.strict || report->beyond().empty()) return kDone;
  fmt::print(stderr, "error: {}: {}\n", arguments.mesh.string(), fmt::join(report->beyond(), "; "));
  return kUnsound;
}

}  // namespace

void add_metrics(CLI::App& app, Commands& commands) {
  const auto [metrics, arguments] =
      add_command(app, commands, "metrics", "Measure a mesh", metrics_command, true);
  metrics->add_option("mesh", arguments.mesh, "mesh file")->required();
  add_size(*metrics, arguments.size, kSizeHelp);
  metrics->add_option("--solve", arguments.solvers, "errors of finite elements, too: poisson, elasticity")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::IsMember(solver_names()));
  metrics->add_flag("--links", arguments.links, "links of flow, too, as Delft3D FM measures them");
  add_criteria(*metrics, arguments.criteria, arguments.strict);
  metrics->add_option("--json", arguments.json, "record to write");
}

}  // namespace delquad
