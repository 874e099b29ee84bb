// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/run_command.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

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
#include "experiments/sweep/draw_figures.h"
#include "program/options.h"
#include "program/print.h"

namespace delquad {
namespace {

struct RunArguments : SweepArguments {
  std::vector<std::filesystem::path> experiments;
  std::optional<std::string> pipelines;  ///< pipelines separated by commas; else the pipelines of the file
  std::vector<std::filesystem::path> peers;  ///< files of further meshers, which are run, too
  long long max_elements = 50'000'000;
  bool dry_run = false;  ///< only say what would be done
  bool allow_triangles = false;
};

/// Returns the shard of "i/n".
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

/// Chooses the named pipelines, and the peers of further files: the named ones of each, or else all.
void choose_pipelines(const RunArguments& arguments, Experiment& experiment) {
  std::vector<std::string> pipelines = experiment.pipelines;
  // Empty words are kept, to be refused.
  if (arguments.pipelines) boost::split(pipelines, *arguments.pipelines, boost::is_any_of(","));
  for (const std::filesystem::path& file : arguments.peers) {
    const std::vector<std::string> names = experiment.add_peer_file(file);
    const auto is_named = [&](const std::string& name) {
      return std::ranges::find(pipelines, name) != pipelines.end();
    };
    if (std::ranges::none_of(names, is_named)) pipelines.insert(pipelines.end(), names.begin(), names.end());
  }
  const auto of_file = static_cast<double>(std::max<std::size_t>(experiment.pipelines.size(), 1));
  experiment.parsed = located("--pipelines", [&] { return experiment.find_pipelines(pipelines); });
  experiment.minutes *= static_cast<double>(experiment.parsed.size()) / of_file;
}

std::vector<Experiment> read_experiments(const RunArguments& arguments) {
  std::vector<Experiment> experiments;
  for (const std::filesystem::path& file : arguments.experiments) {
    if (std::ranges::count(arguments.experiments, file.stem(), &std::filesystem::path::stem) > 1)
      throw InputError(fmt::format(
          "two experiments are called '{}', and their results would share a folder: run them apart",
          file.stem().string()));
    Experiment& experiment =
        experiments.emplace_back(Experiment::read(file, arguments.data, !arguments.pipelines));
    experiment.max_elements = arguments.max_elements;
    choose_pipelines(arguments, experiment);
    experiment.check_calibration();
  }
  return experiments;
}

/// The folder for the results of an experiment: --output, or below it if there are several.
std::filesystem::path folder_of(const RunArguments& arguments, const Experiment& experiment) {
  const bool is_alone = arguments.experiments.size() == 1 || arguments.folder.empty();
  return is_alone ? arguments.folder : arguments.folder / experiment.file.stem();
}

std::string time_text(const std::optional<double>& seconds) {
  constexpr double kMinute = 60;
  if (!seconds) return "its time is not known";
  return *seconds < kMinute ? fmt::format("about {:.0f} s on two cores", *seconds)
                            : fmt::format("about {:.0f} min on two cores", *seconds / kMinute);
}

/// Where each stands, with the time that its file says.
std::vector<PlaceInQueue> queue(const RunArguments& arguments, const std::vector<Experiment>& experiments) {
  std::vector<PlaceInQueue> places(experiments.size());
  std::optional<double> after = 0;
  for (std::size_t i = experiments.size(); i-- > 0;) {
    const auto seconds = expected_seconds(experiments[i], folder_of(arguments, experiments[i]));
    places[i] = {experiments[i].file.stem().string(), i, experiments.size(), seconds, after};
    after = after && seconds ? std::optional(*after + *seconds) : std::nullopt;
  }
  return places;
}

/// Adds the failures of an experiment, under its name.
void add_failures(Outcome& all, const Outcome& one, const std::string& name) {
  all.leftover_triangles += one.leftover_triangles;
  all.bad_inputs += one.bad_inputs;
  all.unsound += one.unsound;
  all.others_failed += one.others_failed;
  all.metrics_failed += one.metrics_failed;
  for (const auto& [reason, cells] : one.failures) {
    std::vector<std::string>& failed = all.failures[reason];
    if (cells.empty()) failed.push_back(name);
    for (const std::string& cell : cells) failed.push_back(name + "/" + cell);
  }
  for (const auto& [reason, cells] : one.inapplicable)
    for (const std::string& cell : cells) all.inapplicable[reason].push_back(name + "/" + cell);
}

/// One after the other, whatever becomes of them; returns what failed of all.
Outcome run_all(const RunArguments& arguments, const std::vector<Experiment>& experiments) {
  const auto print_progress = [](const std::string& text) {
    if (verbosity() != Verbosity::kQuiet) fmt::print(stderr, "{}\n", text);
  };
  const std::vector<PlaceInQueue> places = queue(arguments, experiments);
  Outcome all;
  for (const PlaceInQueue& place : places) {
    if (place.index == 0 && place.seconds && place.seconds_after)
      print_progress(
          fmt::format("{} experiments: {}", place.count, time_text(*place.seconds + *place.seconds_after)));
    print_progress(
        fmt::format("{}/{} {}: {}", place.index + 1, place.count, place.name, time_text(place.seconds)));
    SweepArguments one = arguments;
    one.folder = folder_of(arguments, experiments[place.index]);
    one.options.place = place;
    try {
      add_failures(all, run_and_print(one, experiments[place.index]), place.name);
    } catch (const InputError& error) {
      ++all.bad_inputs;
      all.failures[error.what()].push_back(place.name);
    }
  }
  return all;
}

/// Draws all experiments at once, since Python takes a second to start.
void draw_all(const std::vector<std::filesystem::path>& folders, Outcome& outcome) {
  try {
    const std::string why = draw_figures(folders);
    if (!why.empty() && verbosity() != Verbosity::kQuiet) fmt::print(stderr, "{}\n", why);
  } catch (const InputError& error) {
    ++outcome.bad_inputs;
    outcome.failures[error.what()];
  }
}

int run_command(const RunArguments& arguments) {
  const RunScope run({.threads = threads_of(arguments)});
  const std::vector<Experiment> experiments = read_experiments(arguments);
  if (arguments.dry_run) {
    for (const Experiment& experiment : experiments) {
      if (experiments.size() > 1) fmt::print("{}:\n", experiment.file.string());
      fmt::print("{}", dry_run(experiment, folder_of(arguments, experiment)));
    }
    return kDone;
  }
  if (arguments.folder.empty()) throw InputError("--output is required: only --dry-run goes without");
  Outcome outcome =
      experiments.size() == 1 ? run_and_print(arguments, experiments[0]) : run_all(arguments, experiments);
  std::vector<std::filesystem::path> folders;
  for (const Experiment& experiment : experiments) folders.push_back(folder_of(arguments, experiment));
  draw_all(folders, outcome);
  // A single experiment has just printed the reasons of its cells.
  if (experiments.size() > 1)
    for (const auto& [reason, cells] : outcome.failures)
      if (!cells.empty()) fmt::print(stderr, "error: {} failed: {}\n", fmt::join(cells, ", "), reason);
  return exit_code(outcome, arguments.allow_triangles);
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
  for (const std::string& note : inapplicable_notes(outcome)) fmt::print(stderr, "{}\n", note);
  for (const auto& [reason, cells] : outcome.failures)
    if (cells.empty()) fmt::print(stderr, "error: {}\n", reason);
  if (outcome.others_failed > 0 || outcome.metrics_failed > 0) return kInternalError;
  if (outcome.bad_inputs > 0) return kBadInput;
  if (outcome.unsound > 0) return kUnsound;
  if (outcome.leftover_triangles == 0 || allow_triangles) return kDone;
  fmt::print(stderr,
             "error: {} triangles are left among the quads of the written mesh (--allow-triangles accepts "
             "them) [odd-boundary]\n",
             outcome.leftover_triangles);
  return kTrianglesLeft;
}

void add_run(CLI::App& app, Commands& commands) {
  const auto [run, arguments] =
      add_command(app, commands, "run",
                  "Run experiments: every pipeline on every case, with tables and pictures", run_command);
  run->add_option("experiments", arguments.experiments, "experiment files (.toml), run one after the other")
      ->required();
  run->add_option("-o,--output", arguments.folder,
                  "folder for the results; of several experiments each has its own in it, by its name");
  add_data(*run, arguments.data);
  run->add_option("--pipelines", arguments.pipelines,
                  "pipelines such as F,D,FB,DB; default: the pipelines of the file");
  run->add_option("--peer", arguments.peers, "file of other meshers, which are run beside; may be repeated")
      ->allow_extra_args(false);
  add_max_elements(*run, arguments.max_elements);
  run->add_flag("--allow-triangles", arguments.allow_triangles, kAllowHelp);
  run->add_flag("--allow-unsound", arguments.options.allow_unsound, kUnsoundHelp);
  add_sweep(*run, arguments);
  static const std::map<std::string, bool> pictures = {{"none", false}, {"svg", true}};
  run->add_option("--pictures", arguments.options.pictures,
                  "'svg' (the default): a picture of each mesh, and its fields as .vtu; or 'none'")
      ->transform(CLI::CheckedTransformer(pictures).description("none or svg"));
  run->add_flag("--dry-run", arguments.dry_run,
                "list the cells and which of them are done, about how long the rest takes, "
                "and what could be proven");
  commands.back().only_prints = [&given = arguments] { return given.dry_run; };
}

}  // namespace delquad
