#include <fmt/format.h>

#include <ostream>

#include "apps/check_files.h"
#include "apps/commands.h"
#include "apps/print_metrics.h"
#include "cases/problem.h"
#include "delquad/error.h"
#include "io/mesh_io.h"
#include "metrics/solve/solver_metrics.h"
#include "sweep/record.h"

namespace delquad {

namespace {

void add_solver(const Mesh& mesh, const std::string& solver, MeshMetrics& metrics) {
  SolverOutcome outcome = measure_by_solver(mesh, solver);
  metrics.values.merge(outcome.values);
  if (!outcome.undefined.empty()) metrics.failures[solver] = outcome.undefined;
}

void print_solver(const MeshMetrics& metrics, const std::string& solver) {
  for (const Metric& metric : metrics_of_solver(solver)) print_metric(metric, metrics);
  if (const auto at = metrics.failures.find(solver); at != metrics.failures.end())
    fmt::print(stderr, "warning: no '{}': {}\n", solver, at->second);
}

}  // namespace

int metrics_command(const MetricsArguments& arguments) {
  check_distinct({{"the mesh", arguments.mesh}, {"--json", arguments.json}});
  if (!arguments.json.empty()) check_output(arguments.json);
  ReadNotes notes;
  const Mesh mesh = read_mesh(arguments.mesh, &notes);
  for (const std::string& note : notes) fmt::print(stderr, "note: {}\n", note);
  if (mesh.triangles.empty() && mesh.quads.empty())
    throw InputError(arguments.mesh.string() + ": holds no triangles and no quads to measure");
  std::shared_ptr<const SizeField> size;
  if (arguments.size) size = size_of_mesh(mesh, *arguments.size);
  MeshMetrics metrics = evaluate_metrics(mesh, size.get());
  for (const std::string& solver : arguments.solvers) add_solver(mesh, solver, metrics);
  if (!arguments.json.empty())
    write_file_atomically(arguments.json, [&](std::ostream& out) {
      out << metrics_record(arguments.mesh.string(), arguments.size.value_or(""), metrics);
    });
  fmt::print("{}\n", arguments.mesh.string());
  print_metrics(metrics);
  for (const std::string& solver : arguments.solvers) print_solver(metrics, solver);
  return kDone;
}

}  // namespace delquad
