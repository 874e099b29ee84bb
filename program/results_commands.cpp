#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "base/context.h"
#include "base/parallel.h"
#include "experiments/console/progress.h"
#include "experiments/sweep/merge.h"
#include "experiments/sweep/rerun.h"
#include "experiments/sweep/verify.h"
#include "io/cases/case.h"
#include "io/mesh_io.h"
#include "metrics/metrics.h"
#include "metrics/tables/comparison.h"
#include "metrics/tables/tables.h"
#include "metrics/tables/times.h"
#include "program/commands.h"
#include "program/options.h"
#include "program/print.h"
#include "report/write_report.h"

namespace delquad {
namespace {

namespace fs = std::filesystem;

int tables_command(const fs::path& folder) {
  const Outcome outcome = make_tables(folder);
  print_tables(outcome);
  const std::vector<std::string> errors = write_tables(folder, outcome);
  for (const std::string& error : errors) fmt::print(stderr, "error: {}\n", error);
  return errors.empty() ? kDone : kBadInput;
}

int rerun_command(const fs::path& record, const fs::path& data) {
  const Rerun rerun = rerun_record(record, data);
  for (const auto* lines : {&rerun.differences, &rerun.values})
    for (const std::string& difference : *lines) fmt::print("differs: {}\n", difference);
  fmt::print("{}: {}\n", record.string(),
             !rerun.same_mesh       ? "another mesh"
             : rerun.values.empty() ? "the same mesh, byte for byte"
                                    : "the same mesh, byte for byte, but other values");
  return rerun.same_mesh && rerun.values.empty() ? kDone : kRegression;
}

int verify_command(const fs::path& folder, const fs::path& data, int threads) {
  const RunScope run({.threads = threads});
  const Verification result = verify_results(folder, data);
  for (const std::string& finding : result.findings) fmt::print("{}\n", finding);
  fmt::print("{}: {} records, {} meshes measured again: {}\n", folder.string(), result.cells, result.measured,
             result.findings.empty() ? "all well" : fmt::format("{} findings", result.findings.size()));
  return result.findings.empty() ? kDone : kRegression;
}

int merge_command(const std::vector<fs::path>& folders, const fs::path& output) {
  merge_results(folders, output);
  fmt::print("results: {}\n", output.string());
  return kDone;
}

int report_command(const fs::path& folder, const fs::path& output) {
  const auto problems = write_report(folder, output);
  if (verbosity() != Verbosity::kQuiet)
    for (const std::string& problem : problems) fmt::print(stderr, "warning: {}\n", problem);
  fmt::print("report: {}\n", output.string());
  return kDone;
}

void add_tables(CLI::App& app, Commands& commands) {
  const auto folder = std::make_shared<fs::path>();
  CLI::App* table = app.add_subcommand("tables", "Make the tables of an experiment from its results");
  table->add_option("folder", *folder, "folder of 'delquad run'")->required();
  commands.push_back({table, [folder] { return tables_command(*folder); }});
}

void add_rerun(CLI::App& app, Commands& commands) {
  const auto record = std::make_shared<fs::path>(), data = std::make_shared<fs::path>(kDataFolder);
  CLI::App* again = app.add_subcommand(
      "rerun", "Make a result again from its record: the same bytes, or what stands in their way");
  again->add_option("record", *record, "record.json of a cell")->required();
  add_data(*again, *data);
  commands.push_back({again, [record, data] { return rerun_command(*record, *data); }});
}

void add_verify(CLI::App& app, Commands& commands) {
  const auto folder = std::make_shared<fs::path>(), data = std::make_shared<fs::path>(kDataFolder);
  const auto threads = std::make_shared<int>(thread_count());
  CLI::App* check = app.add_subcommand(
      "verify", "Check that results are as they were written; exit code 1 when something is not");
  check->add_option("folder", *folder, "folder of 'delquad run'")->required();
  add_data(*check, *data);
  check->add_option("-j,--jobs", *threads, "cells at a time; default: all cores")
      ->check(CLI::Range(1, kMostThreads));
  commands.push_back({check, [=] { return verify_command(*folder, *data, *threads); }});
}

void add_merge(CLI::App& app, Commands& commands) {
  const auto folders = std::make_shared<std::vector<fs::path>>();
  const auto output = std::make_shared<fs::path>();
  CLI::App* together = app.add_subcommand(
      "merge", "Put results of one experiment, made in several folders, together in a new one");
  together->add_option("folders", *folders, "folders of 'delquad run', which stay as they are")
      ->required()
      ->expected(2, -1);
  together->add_option("-o,--output", *output, "folder to make")->required();
  commands.push_back({together, [folders, output] { return merge_command(*folders, *output); }});
}

void add_report(CLI::App& app, Commands& commands) {
  const auto folder = std::make_shared<fs::path>(), output = std::make_shared<fs::path>();
  CLI::App* report = app.add_subcommand("report", "Make a page of results to look at in a browser");
  report->add_option("folder", *folder, "folder of 'delquad run', or one that holds several")->required();
  report->add_option("-o,--output", *output, "file to write (.html)")->required();
  commands.push_back({report, [folder, output] { return report_command(*folder, *output); }});
}

struct CompareArguments {
  fs::path before, after;  ///< folders of results, or meshes
  std::vector<std::string> metrics = {"eta_mean", "eta_worst", "d4", "tau", "percent_quads"};
  double tolerance = 0.01;  ///< part of a value by which it may change
};

/// The results in a folder, or the metrics of a mesh.
std::vector<CellRecord> records_of(const fs::path& path) {
  if (!fs::is_regular_file(path)) {
    std::vector<CellRecord> records = read_records(path);
    for (const std::string& problem : attach_times(records)) fmt::print(stderr, "warning: {}\n", problem);
    return records;
  }
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
  add_tables(app, commands);
  add_rerun(app, commands);
  add_verify(app, commands);
  add_merge(app, commands);
  add_report(app, commands);
}

void add_compare(CLI::App& app, Commands& commands) {
  auto given = std::make_shared<CompareArguments>();
  CompareArguments& arguments = *given;
  CLI::App* compare =
      app.add_subcommand("compare", "Compare the results of two runs; exit code 1 when something got worse");
  compare->add_option("before", arguments.before, "folder of results, or a mesh")->required();
  compare->add_option("after", arguments.after, "folder of results, or mesh, to judge")->required();
  compare->add_option("--metrics", arguments.metrics, "keys of records, or 'seconds'")
      ->delimiter(',')
      ->capture_default_str();
  compare->add_option("--tolerance", arguments.tolerance, "part of a value by which it may change")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  commands.push_back({compare, [given] { return compare_command(*given); }});
}

}  // namespace delquad
