#include "program/run_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/algorithm/string/classification.hpp>
#include <boost/algorithm/string/split.hpp>
#include <cmath>
#include <cstdio>
#include <map>

#include "base/context.h"
#include "base/located.h"
#include "base/parallel.h"
#include "base/text.h"
#include "program/options.h"
#include "program/print.h"

namespace delquad {
namespace {

struct RunArguments : SweepArguments {
  std::filesystem::path experiment;
  std::optional<std::string> pipelines;      ///< words separated by commas; else those of the file
  std::vector<std::filesystem::path> peers;  ///< files of further meshers, which are run, too
  long long max_elements = 50'000'000;
  bool dry_run = false;          ///< only say what would be done
  std::optional<double> effect;  ///< whose power is told then
  bool allow_triangles = false;
};

/// Of "i/n".
std::optional<Shard> shard_of(const std::string& text) {
  const auto slash = text.find('/');
  const auto index = as_number(text.substr(0, slash));
  const auto count = slash == std::string::npos ? std::nullopt : as_number(text.substr(slash + 1));
  constexpr double kMost = 1e6;
  const bool good = index && count && *index == std::floor(*index) && *count == std::floor(*count) &&
                    *index >= 0 && *index < *count && *count <= kMost;
  if (!good) return std::nullopt;
  return Shard{static_cast<std::size_t>(*index), static_cast<std::size_t>(*count)};
}

/// Those that are named, and the peers of further files: of each the ones that are named, or else all.
void choose_pipelines(const RunArguments& arguments, Experiment& experiment) {
  std::vector<std::string> pipelines;
  for (const Word& word : experiment.words) pipelines.push_back(word.text);
  // Empty words are kept, to be refused.
  if (arguments.pipelines) boost::split(pipelines, *arguments.pipelines, boost::is_any_of(","));
  for (const std::filesystem::path& file : arguments.peers) {
    const std::vector<std::string> names = experiment.add_peer_file(file);
    const auto is_named = [&](const std::string& name) {
      return std::ranges::find(pipelines, name) != pipelines.end();
    };
    if (std::ranges::none_of(names, is_named)) pipelines.insert(pipelines.end(), names.begin(), names.end());
  }
  experiment.words = located("--pipelines", [&] { return experiment.find_pipelines(pipelines); });
}

int run_command(const RunArguments& arguments) {
  const RunScope run({.threads = threads_of(arguments)});
  Experiment experiment = Experiment::read(arguments.experiment, arguments.data);
  experiment.max_elements = arguments.max_elements;
  choose_pipelines(arguments, experiment);
  experiment.check_calibration();
  if (arguments.dry_run) {
    fmt::print("{}", dry_run(experiment, arguments.folder, arguments.effect));
    return kDone;
  }
  if (arguments.folder.empty()) throw InputError("--output is required: only --dry-run goes without");
  return exit_code(run_and_print(arguments, experiment), arguments.allow_triangles);
}

}  // namespace

void add_sweep(CLI::App& command, SweepArguments& arguments) {
  SweepOptions& sweep = arguments.options;
  command
      .add_option("--threads", arguments.threads,
                  "threads of each process; default: all cores, shared out among the processes")
      ->check(CLI::Range(1, kMostThreads));
  command.add_option("-j,--jobs", sweep.limits.jobs, "cells at a time, each in a process of its own")
      ->capture_default_str()
      ->check(CLI::Range(1, kMostThreads));
  command.add_option("--timeout", sweep.limits.seconds, "seconds after which a cell has failed")
      ->check(kLength);
  command
      .add_option("--memory", sweep.limits.bytes,
                  "memory a cell may take, such as 500M or 4G; more, and it has failed")
      ->transform(CLI::AsSizeValue(false));
  command.add_flag("--force", sweep.force, "run cells again that are done");
  command
      .add_option_function<std::string>(
          "--shard", [&sweep](const std::string& text) { sweep.shard = *shard_of(text); },
          "i/n: the i-th of n parts (from 0), for several runs on one folder")
      ->check([](const std::string& text) {
        return shard_of(text) ? ""
                              : "'" + text.substr(0, 40) + "': expected i/n with 0 <= i < n, such as 0/4";
      });
}

int threads_of(const SweepArguments& arguments) {
  return arguments.threads > 0 ? arguments.threads
                               : std::max(1, thread_count() / arguments.options.limits.jobs);
}

Outcome run_and_print(const SweepArguments& arguments, const Experiment& experiment) {
  const Outcome outcome = run_experiment(experiment, arguments.folder, arguments.options);
  print_tables(outcome);
  fmt::print("results: {}\n", arguments.folder.string());
  return outcome;
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

void add_run(CLI::App& app, Commands& commands) {
  const auto [run, arguments] =
      add_command(app, commands, "run",
                  "Run an experiment: every pipeline on every case, with tables and pictures", run_command);
  run->add_option("experiment", arguments.experiment, "experiment file (.toml)")->required();
  run->add_option("-o,--output", arguments.folder, "folder for the results");
  add_data(*run, arguments.data);
  run->add_option("--pipelines", arguments.pipelines, "words such as F,D,FB,DB; else as the file says");
  run->add_option("--peer", arguments.peers, "file of other meshers, which are run beside; may be repeated")
      ->allow_extra_args(false);
  add_max_elements(*run, arguments.max_elements);
  run->add_flag("--allow-triangles", arguments.allow_triangles, kAllowHelp);
  run->add_flag("--allow-unsound", arguments.options.allow_unsound, kUnsoundHelp);
  add_sweep(*run, arguments);
  static const std::map<std::string, bool> pictures = {{"none", false}, {"svg", true}};
  run->add_option("--pictures", arguments.options.pictures,
                  "of fields and meshes: 'svg' (the default) or 'none'")
      ->transform(CLI::CheckedTransformer(pictures).description("none or svg"));
  CLI::Option* dry =
      run->add_flag("--dry-run", arguments.dry_run,
                    "list the cells and which of them are done, about how long the rest takes, "
                    "and what could be proven");
  run->add_option(
         "--effect", arguments.effect,
         "for --dry-run: a difference in standard deviations of those of the domains, such as 0.5, whose "
         "power is told")
      ->check(kLength)
      ->needs(dry);
  commands.back().only_prints = [&given = arguments] { return given.dry_run; };
}

}  // namespace delquad
