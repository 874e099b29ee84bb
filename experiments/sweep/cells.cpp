// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/sweep/cells.h"

#include <fmt/format.h>

#include <random>

#include "base/activity.h"
#include "base/stopwatch.h"
#include "base/system.h"
#include "delquad/error.h"
#include "experiments/sweep/adapt_loop.h"
#include "experiments/sweep/run_program.h"
#include "geometry/cad/cad_reader.h"
#include "io/cases/problem_record.h"
#include "io/digest.h"
#include "metrics/solve/solver_metrics.h"

namespace delquad {
namespace {

namespace fs = std::filesystem;

std::string& added_parts_text() {
  static std::string text;
  return text;
}

/// The program, its own shared libraries of this project, and the program that reads CAD for it. Each change
/// of an algorithm, an option of the compiler or a library inside changes their bytes.
std::string program_digest() {
  static const std::string program = [] {
    std::string all = versions_record();
    for (const fs::path& file :
         {running_program(), file_of(&program_digest), file_of(&cad_program), cad_library(), cad_program()})
      if (!file.empty()) all += file_digest(file.has_parent_path() ? file : running_program());
    return digest(all);
  }();
  return added_parts_text().empty() ? program : digest(program + added_parts_text());
}

/// Empty where the peer does not tell, and `why` says for what reason.
std::string version_of(const Peer& peer, std::string& why) {
  try {
    return peer_version(peer);
  } catch (const Error& error) {
    why = error.what();
    return "";
  }
}

/// A key that no cell has: what is made of values in memory is never used again.
std::string random_key() {
  std::random_device random;
  return digest(fmt::format("{} {} {} {}", random(), random(), random(), random()));
}

}  // namespace

void set_added_parts(const std::string& text) { added_parts_text() = text; }

std::string model_digest(const Case& c) {
  if (const PlanarModel* model = planar_model(c)) return digest(record_of(*model).dump());
  const std::string example = example_of(c);
  return example.empty() ? file_digest(model_path(c)) : digest("example " + example);
}

CellIdentity identify(const Experiment& experiment, const Case& c, const std::string& model,
                      const Pipeline& pipeline) {
  CellIdentity cell;
  cell.model_digest = model;
  cell.program_digest = program_digest();
  std::string text = pipeline.text;
  if ((cell.peer = experiment.peer_of(pipeline)) != nullptr) {
    cell.peer_version = version_of(*cell.peer, cell.no_peer_version);
    cell.peer_file = fs::absolute(cell.peer->file)
                         .lexically_normal()
                         .lexically_relative(fs::absolute(experiment.file).lexically_normal().parent_path())
                         .generic_string();
    cell.peer_files = command_files(cell.peer->folder, command_of_case(*cell.peer, c.name));
    text += peer_record(cell);
  }
  for (const MetricCommand& metric : experiment.metrics)
    cell.metrics.push_back({&metric, metric_files(metric)});
  cell.solvers = experiment.solvers;
  text += metrics_by_command_record(cell);
  const ProblemRecord problem = record_of(c);
  cell.key = digest(fmt::format("{}\n{}\n{}", problem.digest(), text, cell.program_digest));
  if (!problem.in_memory.empty()) cell.key = random_key();
  return cell;
}

fs::path cell_folder(const fs::path& folder, const Case& c, const Pipeline& pipeline) {
  return folder / c.folder / pipeline.text;
}

std::vector<std::string> measure_by_commands(const CellIdentity& cell, const Case& c,
                                             const std::string& pipeline,
                                             const std::filesystem::path& scratch, MeshResult& result) {
  if (cell.metrics.empty()) return {};
  const StageScope measuring("metrics by command");
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

std::vector<std::string> measure_by_solvers(const CellIdentity& cell, const Case& c, MeshResult& result) {
  if (cell.solvers.empty()) return {};
  const StageScope measuring("solvers");
  const Stopwatch watch;
  std::vector<std::string> failures;
  for (const std::string& solver : cell.solvers) {
    SolverOutcome outcome = measure_by_solver(result.mesh, solver, solution_of(c));
    result.metrics.values.merge(outcome.values);
    if (outcome.undefined.empty()) continue;
    failures.push_back(fmt::format("no '{}': {}", solver, outcome.undefined));
    result.metrics.failures[solver] = outcome.undefined;
  }
  result.log.add_time("solvers", watch.time());
  return failures;
}

}  // namespace delquad
