#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "base/context.h"
#include "base/located.h"
#include "base/parallel.h"
#include "experiments/sweep/run_experiment.h"
#include "experiments/sweep/schema.h"
#include "io/cases/case_keys.h"
#include "program/commands.h"

namespace delquad {

namespace {

/// Empty words are kept, to be refused.
std::vector<std::string> split(const std::string& list) {
  std::vector<std::string> words(1);
  for (const char c : list) {
    if (c == ',')
      words.emplace_back();
    else
      words.back() += c;
  }
  return words;
}

int exit_code(const Outcome& outcome, bool allow_triangles) {
  if (outcome.others_failed > 0 || outcome.metrics_failed > 0) return kInternalError;
  if (outcome.bad_inputs > 0) return kBadInput;
  if (outcome.unsound > 0) return kUnsound;
  if (outcome.leftover_triangles == 0 || allow_triangles) return kDone;
  fmt::print(
      stderr,
      "error: {} triangles are left among the quads of what was written (--allow-triangles accepts them)\n",
      outcome.leftover_triangles);
  return kTrianglesLeft;
}

/// Those that are named, and the peers of further files: of each the ones that are named, or else all.
void choose_pipelines(const RunArguments& arguments, Experiment& experiment) {
  std::vector<std::string> pipelines;
  for (const Word& word : experiment.words) pipelines.push_back(word.text);
  if (arguments.pipelines) pipelines = split(*arguments.pipelines);
  for (const std::filesystem::path& file : arguments.peers) {
    const std::vector<std::string> names = experiment.add_peer_file(file);
    const auto is_named = [&](const std::string& name) {
      return std::ranges::find(pipelines, name) != pipelines.end();
    };
    if (std::ranges::none_of(names, is_named)) pipelines.insert(pipelines.end(), names.begin(), names.end());
  }
  experiment.words = located("--pipelines", [&] { return experiment.find_pipelines(pipelines); });
}

void print_tables(const Outcome& outcome) {
  fmt::print("{}\n", to_markdown(outcome.table));
  if (!outcome.pairs.rows.empty()) fmt::print("{}\n", to_markdown(outcome.pairs));
}

}  // namespace

int run_command(const RunArguments& arguments) {
  const int threads =
      arguments.threads > 0 ? arguments.threads : std::max(1, thread_count() / arguments.options.limits.jobs);
  const RunScope run({.threads = threads});
  Experiment experiment = Experiment::read(arguments.experiment, arguments.data);
  experiment.max_elements = arguments.max_elements;
  choose_pipelines(arguments, experiment);
  experiment.check_calibration();
  if (arguments.dry_run) {
    fmt::print("{}", list_cells(experiment, arguments.folder));
    return kDone;
  }
  const Outcome outcome = run_experiment(experiment, arguments.folder, arguments.options);
  print_tables(outcome);
  fmt::print("results: {}\n", arguments.folder.string());
  return exit_code(outcome, arguments.allow_triangles);
}

int tables_command(const TablesArguments& arguments) {
  const Outcome outcome = make_tables(arguments.folder);
  print_tables(outcome);
  const std::vector<std::string> errors = write_tables(arguments.folder, outcome);
  for (const std::string& error : errors) fmt::print(stderr, "error: {}\n", error);
  return errors.empty() ? kDone : kBadInput;
}

int schema_command(bool options) {
  fmt::print("{}", options ? option_table_text() : experiment_schema());
  return kDone;
}

}  // namespace delquad
