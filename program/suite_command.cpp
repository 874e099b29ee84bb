#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "experiments/suite/submission.h"
#include "experiments/suite/suite_list.h"
#include "program/commands.h"

namespace delquad {
namespace {

struct SuiteArguments {
  std::filesystem::path folder, result;
  SuiteSelection selection;
};

int suite_models_command(const SuiteArguments& given) {
  const std::vector<SuiteModel> models = select_models(given.selection);
  write_suite(given.folder, models);
  fmt::print("{}: {} models, {} of them public\n{}\n", suite_title(), models.size(),
             std::ranges::count(models, SuiteFamily::kPublic, &SuiteModel::family), given.folder.string());
  if (std::ranges::none_of(models, [](const SuiteModel& m) { return !m.file.empty(); }))
    fmt::print("public models that are fetched are absent: 'make public_models', then --public\n");
  return kDone;
}

int suite_add_command(const SuiteArguments& given) {
  const Submission submission = read_submission(given.result);
  const SubmissionCount count = add_submission(submission, given.folder, select_models(given.selection),
                                               select_models({.folders = given.selection.folders}));
  fmt::print("{}: {} meshes measured, {} refused, {} missing: {}\n", submission.program, count.measured,
             count.refused, count.missing, (given.folder / submission.program / "table.md").string());
  return kDone;
}

int suite_table_command(const SuiteArguments& given) {
  const Table table = rank_programs(given.folder);
  write_ranking(given.folder, table);
  fmt::print("{}\n", to_markdown(table));
  return kDone;
}

void add_selection(CLI::App* command, SuiteArguments& given) {
  SuiteSelection& selection = given.selection;
  command->add_option("--models", selection.names, "of these names alone: gear, knot, ...");
  command->add_option("--family", selection.families,
                      "of these alone: planar, CAD, triangles, hard, metric, public");
  command->add_option("--public", selection.folders, "folders in which files of public models lie");
}

}  // namespace

void add_suite(CLI::App& app, Commands& commands) {
  CLI::App* suite = app.add_subcommand("suite", "Compare programs on models that this one makes");
  suite->require_subcommand(1);
  const auto [models, of_models] =
      add_command(*suite, commands, "models", "Write the suite's models and sizes, and the experiment",
                  suite_models_command);
  models->add_option("-o,--output", of_models.folder, "folder to write to")->required();
  add_selection(models, of_models);
  const auto [add, of_add] =
      add_command(*suite, commands, "add", "Measure the meshes of another program", suite_add_command);
  add->add_option("result", of_add.result, "folder of its meshes, with result.toml")->required();
  add->add_option("-o,--output", of_add.folder, "folder of results")->required();
  add_selection(add, of_add);
  const auto [table, of_table] =
      add_command(*suite, commands, "table", "Rank the programs of a folder of results", suite_table_command);
  table->add_option("folder", of_table.folder, "folder of results")->required();
}

}  // namespace delquad
