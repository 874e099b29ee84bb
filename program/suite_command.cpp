#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "base/text.h"
#include "experiments/suite/submission.h"
#include "experiments/suite/suite_list.h"
#include "program/commands.h"

namespace delquad {
namespace {

struct SuiteArguments {
  std::filesystem::path folder, result;
  SuiteSelection selection;
};

auto count_public(const std::vector<SuiteModel>& models) {
  return std::ranges::count(models, SuiteFamily::kPublic, &SuiteModel::family);
}

/// Of public models, unless none were asked for; those that are named are there.
void tell_absent(const SuiteSelection& asked, const std::vector<SuiteModel>& models) {
  const auto all = count_public(suite().models), absent = all - count_public(models);
  const bool any =
      asked.families.empty() || std::ranges::find(asked.families, "public") != asked.families.end();
  if (asked.names.empty() && any && absent > 0)
    fmt::print("{} of {} public models are absent: 'make public_models' fetches them, --public says where\n",
               absent, all);
}

int suite_models_command(const SuiteArguments& given) {
  const std::vector<SuiteModel> models = select_models(given.selection);
  write_suite(given.folder, models);
  fmt::print("{}: {}, {} of them public\n{}\n", suite_title(),
             counted(static_cast<long long>(models.size()), "model"), count_public(models),
             given.folder.string());
  tell_absent(given.selection, models);
  return kDone;
}

int suite_add_command(const SuiteArguments& given) {
  const Submission submission = read_submission(given.result);
  const std::vector<SuiteModel> models = select_models(given.selection);
  const SubmissionCount count =
      add_submission(submission, given.folder, models, select_models({.folders = given.selection.folders}));
  for (const std::string& name : count.of_no_case)
    fmt::print(stderr, "warning: {}: is of no case, and was not measured\n", name);
  tell_absent(given.selection, models);
  fmt::print("{}: cases: {} measured, {} refused, {} missing: {}\n", submission.program, count.measured,
             count.refused, count.missing, (given.folder / submission.program / "table.md").string());
  return count.measured > 0 ? kDone : kBadInput;
}

int suite_table_command(const SuiteArguments& given) {
  const Table table = rank_programs(given.folder);
  write_ranking(given.folder, table);
  fmt::print("{}\n", to_markdown(table));
  return kDone;
}

void add_selection(CLI::App* command, SuiteArguments& given) {
  SuiteSelection& selection = given.selection;
  command->add_option("--models", selection.names, "those of these names alone: gear, knot, ...");
  command->add_option("--family", selection.families,
                      "those of these families alone, with --models those of both: planar, CAD, triangles, "
                      "hard, metric, public");
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
