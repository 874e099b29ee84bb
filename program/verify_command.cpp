#include "experiments/sweep/verify.h"

#include <fmt/format.h>

#include "base/context.h"
#include "program/commands.h"

namespace delquad {

int verify_command(const VerifyArguments& arguments) {
  const RunScope run({.threads = arguments.threads});
  const Verification result = verify_results(arguments.folder, arguments.data);
  for (const std::string& finding : result.findings) fmt::print("{}\n", finding);
  fmt::print("{}: {} records, {} meshes measured again: {}\n", arguments.folder.string(), result.cells,
             result.measured,
             result.findings.empty() ? "all well" : fmt::format("{} findings", result.findings.size()));
  return result.findings.empty() ? kDone : kRegression;
}

}  // namespace delquad
