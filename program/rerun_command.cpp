#include <fmt/format.h>

#include <cstdio>

#include "experiments/sweep/rerun.h"
#include "program/commands.h"

namespace delquad {

int rerun_command(const RerunArguments& arguments) {
  const Rerun rerun = rerun_record(arguments.record, arguments.data);
  for (const auto* lines : {&rerun.differences, &rerun.values})
    for (const std::string& difference : *lines) fmt::print("differs: {}\n", difference);
  fmt::print("{}: {}\n", arguments.record.string(),
             !rerun.same_mesh       ? "another mesh"
             : rerun.values.empty() ? "the same mesh, byte for byte"
                                    : "the same mesh, byte for byte, but other values");
  return rerun.same_mesh && rerun.values.empty() ? kDone : kRegression;
}

}  // namespace delquad
