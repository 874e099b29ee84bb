#include "report/write_report.h"

#include <fmt/format.h>

#include "apps/commands.h"

namespace delquad {

int report_command(const ReportArguments& arguments) {
  for (const std::string& problem : write_report(arguments.folder, arguments.output))
    fmt::print(stderr, "warning: {}\n", problem);
  fmt::print("report: {}\n", arguments.output.string());
  return kDone;
}

}  // namespace delquad
