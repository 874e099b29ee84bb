#include <fmt/format.h>

#include <cstdio>

#include "apps/commands.h"
#include "sweep/rerun.h"

namespace delquad {

int rerun_command(const RerunArguments& arguments) {
  const Rerun rerun = rerun_record(arguments.record);
  for (const std::string& difference : rerun.differences) fmt::print("differs: {}\n", difference);
  fmt::print("{}: {}\n", arguments.record.string(),
             rerun.same_mesh ? "the same mesh, byte for byte" : "another mesh");
  return rerun.same_mesh ? kDone : kRegression;
}

}  // namespace delquad
