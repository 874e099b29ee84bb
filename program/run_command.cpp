#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>

#include "base/context.h"
#include "base/located.h"
#include "base/parallel.h"
#include "base/text.h"
#include "experiments/sweep/run_experiment.h"
#include "io/cases/case.h"
#include "program/commands.h"
#include "program/options.h"
#include "program/print.h"

namespace delquad {
namespace {

struct RunArguments {
  std::filesystem::path experiment, folder;
  std::filesystem::path data = kDataFolder;
  std::optional<std::string> pipelines;      ///< words separated by commas; else those of the file
  std::vector<std::filesystem::path> peers;  ///< files of further meshers, which are run, too
  long long max_elements = 50'000'000;
  int threads = 0;  ///< of each process; 0: the cores, shared out among the processes
  SweepOptions options;
  bool dry_run = false;  ///< only list the cells
  bool allow_triangles = false;
};

/// "i/n"
const CLI::Validator kShard(
    [](std::string& text) -> std::string {
      const auto slash = text.find('/');
      const auto index = as_number(text.substr(0, slash));
      const auto count = slash == std::string::npos ? std::nullopt : as_number(text.substr(slash + 1));
      constexpr double kMost = 1e6;
      const bool good = index && count && *index == std::floor(*index) && *count == std::floor(*count) &&
                        *index >= 0 && *index < *count && *count <= kMost;
      return good ? "" : "'" + text.substr(0, 40) + "': expected i/n with 0 <= i < n, such as 0/4";
    },
    "");

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

}  // namespace

void add_run(CLI::App& app, Commands& commands) {
  auto given = std::make_shared<RunArguments>();
  RunArguments& arguments = *given;
  CLI::App* run =
      app.add_subcommand("run", "Run an experiment: every pipeline on every case, with tables and pictures");
  run->add_option("experiment", arguments.experiment, "experiment file (.toml)")->required();
  run->add_option("-o,--output", arguments.folder, "folder for the results")->required();
  add_data(*run, arguments.data);
  run->add_option("--pipelines", arguments.pipelines, "words such as F,D,FB,DB; else as the file says");
  run->add_option("--peer", arguments.peers, "file of other meshers, which are run beside; may be repeated")
      ->allow_extra_args(false);
  add_max_elements(*run, arguments.max_elements);
  run->add_option("--threads", arguments.threads,
                  "threads of each process; default: all cores, shared out among the processes")
      ->check(CLI::Range(1, kMostThreads));
  run->add_flag("--allow-triangles", arguments.allow_triangles, kAllowHelp);
  run->add_flag("--allow-unsound", arguments.options.allow_unsound, kUnsoundHelp);
  SweepOptions& sweep = arguments.options;
  run->add_option("-j,--jobs", sweep.limits.jobs, "cells at a time, each in a process of its own")
      ->capture_default_str()
      ->check(CLI::Range(1, kMostThreads));
  run->add_option("--timeout", sweep.limits.seconds, "seconds after which a cell has failed")->check(kLength);
  run->add_option("--memory", sweep.limits.bytes,
                  "memory a cell may take, such as 500M or 4G; more, and it has failed")
      ->transform(CLI::AsSizeValue(false));
  static const std::map<std::string, bool> pictures = {{"none", false}, {"svg", true}};
  run->add_option("--pictures", sweep.pictures, "of fields and meshes: 'svg' (the default) or 'none'")
      ->transform(CLI::CheckedTransformer(pictures).description("none or svg"));
  run->add_flag("--force", sweep.force, "run cells again that are done");
  run->add_flag("--dry-run", arguments.dry_run, "list the cells, and which of them are done");
  run->add_option_function<std::string>(
         "--shard",
         [&sweep](const std::string& text) {
           const auto slash = text.find('/');
           sweep.shard = {std::stoul(text.substr(0, slash)), std::stoul(text.substr(slash + 1))};
         },
         "i/n: the i-th of n parts (from 0), for several runs on one folder")
      ->check(kShard);
  commands.push_back({run, [given] { return run_command(*given); }, [given] { return given->dry_run; }});
}

}  // namespace delquad
