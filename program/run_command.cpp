#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>

#include "base/context.h"
#include "base/located.h"
#include "base/parallel.h"
#include "base/text.h"
#include "experiments/sweep/folders.h"
#include "experiments/sweep/run_experiment.h"
#include "io/cases/case.h"
#include "io/cases/read_problem.h"
#include "io/mesh_io.h"
#include "metrics/judgement/criteria.h"
#include "program/commands.h"
#include "program/options.h"
#include "program/print.h"
#include "report/write_report.h"

namespace delquad {
namespace {

namespace fs = std::filesystem;

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

Outcome run_and_print(const RunArguments& arguments, const Experiment& experiment) {
  const Outcome outcome = run_experiment(experiment, arguments.folder, arguments.options);
  print_tables(outcome);
  fmt::print("results: {}\n", arguments.folder.string());
  return outcome;
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
  return exit_code(run_and_print(arguments, experiment), arguments.allow_triangles);
}

/// Of all parts in a folder, which make an experiment.
struct BatchArguments {
  RunArguments run;
  std::optional<std::string> size;
  std::string quality = "best", criteria = "batch";
  std::optional<double> ignore_below;
  fs::path settings;   ///< further keys for all parts
  std::string format;  ///< extension of further meshes; empty: none
  bool strict = false;
};

/// TOML and JSON have the same texts.
std::string quoted(const std::string& text) { return nlohmann::json(text).dump(); }

/// The parts in a folder by their names in the experiment, which fit for folders.
std::map<std::string, fs::path> parts_in(const fs::path& folder) {
  std::error_code error;
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder, error))
    if (entry.is_regular_file() && is_surface_file(entry.path())) files.push_back(entry.path().filename());
  if (error) throw InputError(folder.string() + ": " + error.message() + ": expected a folder of models");
  if (files.empty()) throw InputError(folder.string() + ": no models: expected files " + surface_files());
  std::ranges::sort(files);
  const auto in_small = [](std::string text) {
    std::ranges::transform(text, text.begin(), [](unsigned char c) { return std::tolower(c); });
    return text;
  };
  std::map<std::string, fs::path> parts;
  std::set<std::string> taken;
  for (const fs::path& file : files) {
    std::string plain = file.stem().string();
    for (char& c : plain)
      if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '_' && c != '-') c = '_';
    std::string name = plain;
    for (int n = 2; !taken.insert(in_small(name)).second; ++n) name = fmt::format("{}_{}", plain, n);
    parts[name] = file;
  }
  return parts;
}

std::string experiment_of(const BatchArguments& arguments, const std::map<std::string, fs::path>& parts) {
  const Quality& quality = quality_named(arguments.quality);
  const bool is_preset = std::ranges::any_of(
      criteria_presets(), [&](const Criteria& preset) { return preset.name == arguments.criteria; });
  std::string text = fmt::format(
      "# Made by `delquad batch`; `delquad run` reads it, too.\ntitle = {}\npipelines = [{}]\ncross = {}\n"
      "columns = [\"n_quads\", \"failing\", \"time_step\", \"deviation\", \"eta_mean\", \"eta_worst\", "
      "\"warnings\", \"seconds\"]\ncriteria = {}\n",
      quoted("Parts of " + arguments.run.data.string()), quoted(quality.word),
      quoted(text_of({.kind = quality.cross})),
      quoted(is_preset ? arguments.criteria : fs::absolute(arguments.criteria).string()));
  if (arguments.size)
    text +=
        fmt::format("size = {}\n", as_number(*arguments.size) ? *arguments.size : quoted(*arguments.size));
  if (arguments.ignore_below) text += fmt::format("surface.ignore_below = {}\n", *arguments.ignore_below);
  if (!arguments.settings.empty())
    text += "\n# " + arguments.settings.string() + "\n" + file_bytes(arguments.settings);
  for (const auto& [name, file] : parts)
    text += fmt::format("\n[[case]]\nname = {}\ndata = {}\n", quoted(name), quoted(file.string()));
  return text;
}

/// Of the parts that are done; what an earlier run wrote of others goes.
void write_parts(const BatchArguments& arguments, const std::vector<CellRecord>& records) {
  const fs::path meshes = arguments.run.folder / "meshes";
  prepare_folder(meshes);
  for (const CellRecord& record : records) {
    const fs::path file = meshes / (record.group + arguments.format);
    if (record.reason.empty())
      write_mesh(file, read_mesh(record.folder / "mesh.msh"));
    else
      fs::remove(file);
  }
}

int batch_command(BatchArguments arguments) {
  RunArguments& run_as = arguments.run;
  const auto parts = parts_in(run_as.data);
  if (!arguments.format.empty() && arguments.format[0] != '.') arguments.format.insert(0, ".");
  if (!arguments.format.empty()) check_mesh_format("part" + arguments.format);
  prepare_folder(run_as.folder);
  run_as.experiment = run_as.folder / "batch.toml";
  write_text_file(run_as.experiment, experiment_of(arguments, parts));
  const int threads = std::max(1, thread_count() / run_as.options.limits.jobs);
  const RunScope scope({.threads = run_as.threads > 0 ? run_as.threads : threads});
  const Outcome outcome = run_and_print(run_as, Experiment::read(run_as.experiment, run_as.data));
  const fs::path page = run_as.folder / "index.html";
  for (const std::string& problem : write_report(run_as.folder, page))
    fmt::print(stderr, "warning: {}\n", problem);
  fmt::print("page: {}\n", page.string());
  const std::vector<CellRecord> records = read_records(run_as.folder);
  if (!arguments.format.empty()) write_parts(arguments, records);
  const auto fails = [](const CellRecord& record) {
    const auto at = record.values.find("failing");
    return at != record.values.end() && at->second > 0;
  };
  const auto failing = std::ranges::count_if(records, fails);
  const auto meshed =
      std::ranges::count_if(records, [](const CellRecord& record) { return record.reason.empty(); });
  fmt::print("{} of {} parts were meshed, {} have elements that fail\n", meshed, records.size(), failing);
  const int code = exit_code(outcome, false);
  return code == kDone && arguments.strict && failing > 0 ? kUnsound : code;
}

void add_sweep_options(CLI::App& command, SweepOptions& sweep, int& threads) {
  command
      .add_option("--threads", threads,
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
          "--shard",
          [&sweep](const std::string& text) {
            const auto slash = text.find('/');
            sweep.shard = {std::stoul(text.substr(0, slash)), std::stoul(text.substr(slash + 1))};
          },
          "i/n: the i-th of n parts (from 0), for several runs on one folder")
      ->check(kShard);
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
  run->add_flag("--allow-triangles", arguments.allow_triangles, kAllowHelp);
  run->add_flag("--allow-unsound", arguments.options.allow_unsound, kUnsoundHelp);
  SweepOptions& sweep = arguments.options;
  add_sweep_options(*run, sweep, arguments.threads);
  static const std::map<std::string, bool> pictures = {{"none", false}, {"svg", true}};
  run->add_option("--pictures", sweep.pictures, "of fields and meshes: 'svg' (the default) or 'none'")
      ->transform(CLI::CheckedTransformer(pictures).description("none or svg"));
  run->add_flag("--dry-run", arguments.dry_run, "list the cells, and which of them are done");
  commands.push_back({run, [given] { return run_command(*given); }, [given] { return given->dry_run; }});
}

void add_batch(CLI::App& app, Commands& commands) {
  auto given = std::make_shared<BatchArguments>();
  BatchArguments& arguments = *given;
  CLI::App* batch = app.add_subcommand(
      "batch", "Mesh all parts in a folder by the same settings: an experiment, a table, a page, meshes");
  batch->add_option("folder", arguments.run.data, "folder of models")->required();
  batch->add_option("-o,--output", arguments.run.folder, "folder for the results")->required();
  add_size(*batch, arguments.size, kSizeHelp);
  batch->add_option("--quality", arguments.quality, "fast, good or best")->capture_default_str();
  add_criteria(*batch, arguments.criteria, arguments.strict);
  batch->add_option("--ignore-below", arguments.ignore_below, "leave out what of the models is smaller")
      ->check(kLength);
  batch->add_option("--settings", arguments.settings,
                    "file with further keys of experiments, for all parts (.toml)");
  batch->add_option("--format", arguments.format, "write meshes in this format, too, such as .inp");
  add_sweep_options(*batch, arguments.run.options, arguments.run.threads);
  commands.push_back({batch, [given] { return batch_command(*given); }});
}

}  // namespace delquad
