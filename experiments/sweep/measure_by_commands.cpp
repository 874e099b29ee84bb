#include "experiments/sweep/measure_by_commands.h"

#include <fmt/format.h>

#include "base/activity.h"
#include "base/stopwatch.h"
#include "io/mesh_io.h"
#include "metrics/solve/solver_metrics.h"

namespace delquad {

std::vector<std::string> measure_by_commands(const CellIdentity& cell, const Case& c,
                                             const std::string& pipeline,
                                             const std::filesystem::path& scratch, MeshResult& result) {
  if (cell.metrics.empty()) return {};
  const DoingStage measuring("metrics by command");
  const Stopwatch watch;
  std::vector<std::string> failures;
  std::filesystem::create_directories(scratch);
  write_mesh(scratch / "mesh.msh", result.mesh);
  for (const auto& [metric, files] : cell.metrics) {
    MetricOutcome outcome = run_metric(*metric, c, pipeline, scratch);
    result.metrics.values.merge(outcome.values);
    if (outcome.failure.empty()) continue;
    failures.push_back(fmt::format("no '{}': {}", metric->metric.key, outcome.failure));
    result.metrics.failures[metric->metric.key] = outcome.failure;
  }
  result.log.add_time("metrics by command", watch.time());
  return failures;
}

std::vector<std::string> measure_by_solvers(const CellIdentity& cell, MeshResult& result) {
  if (cell.solvers.empty()) return {};
  const DoingStage measuring("solvers");
  const Stopwatch watch;
  std::vector<std::string> failures;
  for (const std::string& solver : cell.solvers) {
    SolverOutcome outcome = measure_by_solver(result.mesh, solver);
    result.metrics.values.merge(outcome.values);
    if (outcome.undefined.empty()) continue;
    failures.push_back(fmt::format("no '{}': {}", solver, outcome.undefined));
    result.metrics.failures[solver] = outcome.undefined;
  }
  result.log.add_time("solvers", watch.time());
  return failures;
}

}  // namespace delquad
