#include "report/write_report.h"

#include <fmt/format.h>

#include "apps/commands.h"
#include "console/progress.h"

namespace delquad {

int report_command(const ReportArguments& arguments) {
  const auto problems = write_report(arguments.folder, arguments.output);
  if (verbosity() != Verbosity::kQuiet)
    for (const std::string& problem : problems) fmt::print(stderr, "warning: {}\n", problem);
  fmt::print("report: {}\n", arguments.output.string());
  return kDone;
}

}  // namespace delquad
