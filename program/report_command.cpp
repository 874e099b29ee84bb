#include "report/write_report.h"

#include <fmt/format.h>

#include "experiments/console/progress.h"
#include "program/commands.h"

namespace delquad {

int report_command(const ReportArguments& arguments) {
  const auto problems = write_report(arguments.folder, arguments.output);
  if (verbosity() != Verbosity::kQuiet)
    for (const std::string& problem : problems) fmt::print(stderr, "warning: {}\n", problem);
  fmt::print("report: {}\n", arguments.output.string());
  return kDone;
}

}  // namespace delquad
