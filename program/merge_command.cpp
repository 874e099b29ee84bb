#include "experiments/sweep/merge.h"

#include <fmt/format.h>

#include "program/commands.h"

namespace delquad {

int merge_command(const MergeArguments& arguments) {
  merge_results(arguments.folders, arguments.output);
  fmt::print("results: {}\n", arguments.output.string());
  return kDone;
}

}  // namespace delquad
