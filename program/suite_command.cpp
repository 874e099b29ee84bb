#include <fmt/format.h>

#include "experiments/suite/ranking.h"
#include "experiments/suite/submission.h"
#include "experiments/suite/suite_list.h"
#include "experiments/suite/write_suite.h"
#include "program/commands.h"

namespace delquad {

int suite_models_command(const SuiteArguments& arguments) {
  write_suite(arguments.folder);
  fmt::print("{}: {} models\n{}\n", suite_title(), suite().models.size(), arguments.folder.string());
  return kDone;
}

int suite_add_command(const SuiteArguments& arguments) {
  const Submission submission = read_submission(arguments.result);
  const SubmissionCount count = add_submission(submission, arguments.folder);
  fmt::print("{}: {} meshes measured, {} refused, {} missing: {}\n", submission.program, count.measured,
             count.refused, count.missing, (arguments.folder / submission.program / "table.md").string());
  return kDone;
}

int suite_table_command(const SuiteArguments& arguments) {
  const Table table = rank_programs(arguments.folder);
  write_ranking(arguments.folder, table);
  fmt::print("{}\n", to_markdown(table));
  return kDone;
}

}  // namespace delquad
