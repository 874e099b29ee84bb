// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "base/context.h"
#include "base/text.h"
#include "experiments/report/write_report.h"
#include "experiments/sweep/folders.h"
#include "io/cases/read_problem.h"
#include "io/mesh_io.h"
#include "metrics/judgement/criteria.h"
#include "metrics/tables/samples.h"
#include "program/options.h"
#include "program/run_command.h"

namespace delquad {
namespace {

namespace fs = std::filesystem;

/// Arguments for all parts in a folder, which make an experiment.
struct BatchArguments : SweepArguments {
  std::optional<std::string> size;
  std::string quality = "best", criteria = "batch";
  std::optional<double> ignore_below;
  bool idealize = false;
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
  if (files.empty())
    throw InputError(folder.string() + ": no models: expected files " + surface_files() +
                     "; 'delquad run' takes planar models");
  std::ranges::sort(files);
  std::map<std::string, fs::path> parts;
  std::set<std::string> taken;
  for (const fs::path& file : files) {
    std::string plain = file.stem().string();
    for (char& c : plain)
      if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '_' && c != '-') c = '_';
    std::string name = plain;
    for (int n = 2; !taken.insert(upper(name)).second; ++n) name = fmt::format("{}_{}", plain, n);
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
      quoted("Parts of " + arguments.data.string()), quoted(quality.pipeline),
      quoted(text_of({.kind = quality.cross})),
      quoted(is_preset ? arguments.criteria : fs::absolute(arguments.criteria).string()));
  for (const auto& [name, value] : quality.options.values())
    text += fmt::format("{} = {}\n", name, text_of(value));
  if (arguments.size)
    text +=
        fmt::format("size = {}\n", as_number(*arguments.size) ? *arguments.size : quoted(*arguments.size));
  if (arguments.ignore_below) text += fmt::format("surface.ignore_below = {}\n", *arguments.ignore_below);
  if (arguments.idealize) text += "surface.idealize = true\n";
  if (!arguments.settings.empty())
    text += "\n# " + arguments.settings.string() + "\n" + file_bytes(arguments.settings);
  for (const auto& [name, file] : parts)
    text += fmt::format("\n[[case]]\nname = {}\ndata = {}\n", quoted(name), quoted(file.string()));
  return text;
}

/// Writes the meshes of the finished parts, and removes the other files of an earlier run.
void write_parts(const fs::path& meshes, const std::string& extension,
                 const std::vector<CellRecord>& records) {
  prepare_folder(meshes);
  for (const CellRecord& record : records) {
    const fs::path file = meshes / (record.group + extension);
    if (record.reason.empty())
      write_mesh(file, read_mesh(record.folder / "mesh.msh"));
    else
      fs::remove(file);
  }
}

int batch_command(const BatchArguments& arguments) {
  const auto parts = parts_in(arguments.data);
  const std::string& format = arguments.format;
  const std::string extension = format.empty() || format[0] == '.' ? format : "." + format;
  if (!extension.empty()) check_mesh_format("part" + extension);
  read_criteria(arguments.criteria);
  const std::string text = experiment_of(arguments, parts);
  prepare_folder(arguments.folder);
  const fs::path experiment = arguments.folder / "batch.toml", page = arguments.folder / "index.html";
  write_text_file(experiment, text);
  const RunScope scope({.threads = threads_of(arguments)});
  const Outcome outcome = run_and_print(arguments, Experiment::read(experiment, arguments.data));
  for (const std::string& problem : write_report(arguments.folder, page))
    fmt::print(stderr, "warning: {}\n", problem);
  fmt::print("page: {}\n", page.string());
  const std::vector<CellRecord> records = read_records(arguments.folder);
  if (!extension.empty()) write_parts(arguments.folder / "meshes", extension, records);
  const auto failing =
      std::ranges::count_if(records, [](const CellRecord& r) { return value_of(r, "failing") > 0; });
  fmt::print("{} of {} parts were meshed, {} have elements that fail\n",
             std::ranges::count(records, "", &CellRecord::reason), records.size(), failing);
  const int code = exit_code(outcome, false);
  return code == kDone && arguments.strict && failing > 0 ? kUnsound : code;
}

}  // namespace

void add_batch(CLI::App& app, Commands& commands) {
  const auto [batch, arguments] =
      add_command(app, commands, "batch",
                  "Mesh all parts in a folder by the same settings: an experiment, a table, a page, meshes",
                  batch_command);
  batch->add_option("folder", arguments.data, "folder of models")->required();
  batch->add_option("-o,--output", arguments.folder, "folder for the results")->required();
  add_size(*batch, arguments.size, kSizeHelp);
  batch->add_option("--quality", arguments.quality, "fast, good, best or regular")->capture_default_str();
  add_criteria(*batch, arguments.criteria, arguments.strict);
  batch->add_flag("--idealize", arguments.idealize, "leave out what is below min_length of the criteria");
  batch->add_option("--ignore-below", arguments.ignore_below, "leave out what of the models is smaller")
      ->check(kLength);
  batch->add_option("--settings", arguments.settings,
                    "file with further keys of experiments, for all parts (.toml)");
  batch->add_option("--format", arguments.format, "write meshes in this format, too, such as .inp");
  add_sweep(*batch, arguments);
}

}  // namespace delquad
