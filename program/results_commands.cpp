// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "base/context.h"
#include "base/parallel.h"
#include "experiments/console/progress.h"
#include "experiments/report/write_report.h"
#include "experiments/sweep/draw_figures.h"
#include "experiments/sweep/merge.h"
#include "experiments/sweep/verify.h"
#include "io/cases/case.h"
#include "io/mesh_io.h"
#include "metrics/tables/comparison.h"
#include "metrics/tables/result_records.h"
#include "metrics/tables/tables.h"
#include "program/commands.h"
#include "program/options.h"
#include "program/print.h"

namespace delquad {
namespace {

namespace fs = std::filesystem;

/// Arguments of commands on folders of results; each command has its own copy.
struct ResultsArguments {
  fs::path folder;  ///< of rerun: a record
  fs::path output, data = kDataFolder;
  std::vector<fs::path> folders;
  int threads = thread_count();
};

/// Why there are no figures; empty: there are.
void print_undrawn(const std::string& why) {
  if (!why.empty() && verbosity() != Verbosity::kQuiet) fmt::print(stderr, "{}\n", why);
}

int tables_command(const ResultsArguments& given) {
  const Outcome outcome = make_tables(given.folder);
  print_tables(outcome);
  const std::vector<std::string> errors = write_tables(given.folder, outcome);
  print_undrawn(draw_figures({given.folder}));
  for (const std::string& error : errors) fmt::print(stderr, "error: {}\n", error);
  return errors.empty() ? kDone : kBadInput;
}

int rerun_command(const ResultsArguments& given) {
  const Rerun rerun = rerun_record(given.folder, given.data);
  for (const auto* lines : {&rerun.differences, &rerun.values})
    for (const std::string& difference : *lines) fmt::print("differs: {}\n", difference);
  fmt::print("{}: {}\n", given.folder.string(),
             !rerun.same_mesh       ? "another mesh"
             : rerun.values.empty() ? "the same mesh, byte for byte"
                                    : "the same mesh, byte for byte, but other values");
  return rerun.same_mesh && rerun.values.empty() ? kDone : kRegression;
}

int verify_command(const ResultsArguments& given) {
  const RunScope run({.threads = given.threads});
  const Verification result = verify_results(given.folder, given.data);
  print_undrawn(result.undrawn);
  for (const std::string& finding : result.findings) fmt::print("{}\n", finding);
  fmt::print("{}: {} records, {} meshes measured again: {}\n", given.folder.string(), result.cells,
             result.measured,
             result.findings.empty() ? "all well" : fmt::format("{} findings", result.findings.size()));
  return result.findings.empty() ? kDone : kRegression;
}

int merge_command(const ResultsArguments& given) {
  merge_results(given.folders, given.output);
  print_undrawn(draw_figures({given.output}));
  fmt::print("results: {}\n", given.output.string());
  return kDone;
}

int report_command(const ResultsArguments& given) {
  const auto problems = write_report(given.folder, given.output);
  if (verbosity() != Verbosity::kQuiet)
    for (const std::string& problem : problems) fmt::print(stderr, "warning: {}\n", problem);
  fmt::print("report: {}\n", given.output.string());
  return kDone;
}

struct CompareArguments {
  fs::path before, after;  ///< folders of results, or meshes
  std::vector<std::string> metrics = {"eta_mean", "eta_worst", "d4", "tau", "percent_quads"};
  double tolerance = 0.01;  ///< part of a value by which it may change
};

/// The results in a folder, or the metrics of a mesh.
std::vector<CellRecord> records_of(const fs::path& path) {
  if (!fs::is_regular_file(path)) return read_records(path);
  CellRecord record;
  record.group = "mesh";
  record.values = evaluate_metrics(read_mesh(path), nullptr).values;
  return {record};
}

int compare_command(const CompareArguments& arguments) {
  const Comparison comparison = compare_records(records_of(arguments.before), records_of(arguments.after),
                                                arguments.metrics, arguments.tolerance);
  fmt::print("{}", to_text(comparison));
  return comparison.regressed() ? kRegression : kDone;
}

}  // namespace

void add_results(CLI::App& app, Commands& commands) {
  const auto add = [&](const char* name, const char* about, int (*run)(const ResultsArguments&)) {
    return add_command(app, commands, name, about, run);
  };
  constexpr const char* kFolder = "folder of 'delquad run'";
  const auto [tables, of_tables] =
      add("tables", "Make the tables of an experiment from its results", tables_command);
  tables->add_option("folder", of_tables.folder, kFolder)->required();

  const auto [rerun, of_rerun] = add(
      "rerun",
      "Make a result again from its record: the same bytes, or what differs. Results with parts in Python "
      "need these parts: call delquad.run([\"rerun\", ...]) there",
      rerun_command);
  rerun->add_option("record", of_rerun.folder, "record.json of a cell")->required();
  add_data(*rerun, of_rerun.data);

  const auto [verify, of_verify] = add(
      "verify",
      "Check that results are as they were written; exit code 1 if something is not. Results with parts in "
      "Python need these parts: call delquad.run([\"verify\", ...]) there",
      verify_command);
  verify->add_option("folder", of_verify.folder, kFolder)->required();
  add_data(*verify, of_verify.data);
  verify->add_option("-j,--jobs", of_verify.threads, "cells at a time; default: all cores")
      ->check(CLI::Range(1, kMostThreads));

  const auto [merge, of_merge] =
      add("merge", "Put results of one experiment, made in several folders, together in a new one",
          merge_command);
  merge->add_option("folders", of_merge.folders, "folders of 'delquad run', which stay as they are")
      ->required()
      ->expected(2, -1);
  merge->add_option("-o,--output", of_merge.output, "folder to make")->required();

  const auto [report, of_report] =
      add("report", "Make a page of results to look at in a browser", report_command);
  report->add_option("folder", of_report.folder, "folder of 'delquad run', or one that holds several")
      ->required();
  report->add_option("-o,--output", of_report.output, "file to write (.html)")->required();
}

void add_compare(CLI::App& app, Commands& commands) {
  const auto [compare, arguments] =
      add_command(app, commands, "compare",
                  "Compare the results of two runs; exit code 1 when something got worse", compare_command);
  compare->add_option("before", arguments.before, "folder of results, or a mesh")->required();
  compare->add_option("after", arguments.after, "folder of results, or mesh, to judge")->required();
  compare->add_option("--metrics", arguments.metrics, "keys of records, or 'seconds'")
      ->delimiter(',')
      ->capture_default_str();
  compare->add_option("--tolerance", arguments.tolerance, "part of a value by which it may change")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
}

}  // namespace delquad
