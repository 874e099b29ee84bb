#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "experiments/suite/ranking.h"
#include "experiments/suite/submission.h"
#include "experiments/suite/suite_list.h"
#include "experiments/suite/write_suite.h"
#include "program/commands.h"

namespace delquad {
namespace {

int suite_models_command(const std::filesystem::path& folder) {
  write_suite(folder);
  fmt::print("{}: {} models\n{}\n", suite_title(), suite().models.size(), folder.string());
  return kDone;
}

int suite_add_command(const std::filesystem::path& result, const std::filesystem::path& folder) {
  const Submission submission = read_submission(result);
  const SubmissionCount count = add_submission(submission, folder);
  fmt::print("{}: {} meshes measured, {} refused, {} missing: {}\n", submission.program, count.measured,
             count.refused, count.missing, (folder / submission.program / "table.md").string());
  return kDone;
}

int suite_table_command(const std::filesystem::path& folder) {
  const Table table = rank_programs(folder);
  write_ranking(folder, table);
  fmt::print("{}\n", to_markdown(table));
  return kDone;
}

}  // namespace

void add_suite(CLI::App& app, Commands& commands) {
  namespace fs = std::filesystem;
  const auto folder = std::make_shared<fs::path>(), result = std::make_shared<fs::path>();
  CLI::App* suite = app.add_subcommand("suite", "Compare programs on models that this one makes");
  suite->require_subcommand(1);
  CLI::App* models =
      suite->add_subcommand("models", "Write the suite's models and sizes, and the experiment");
  models->add_option("-o,--output", *folder, "folder to write to")->required();
  CLI::App* add = suite->add_subcommand("add", "Measure the meshes of another program");
  add->add_option("result", *result, "folder of its meshes, with result.toml")->required();
  add->add_option("-o,--output", *folder, "folder of results")->required();
  CLI::App* table = suite->add_subcommand("table", "Rank the programs of a folder of results");
  table->add_option("folder", *folder, "folder of results")->required();
  commands.push_back({models, [folder] { return suite_models_command(*folder); }});
  commands.push_back({add, [result, folder] { return suite_add_command(*result, *folder); }});
  commands.push_back({table, [folder] { return suite_table_command(*folder); }});
}

}  // namespace delquad
