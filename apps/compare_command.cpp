#include <fmt/format.h>

#include "apps/commands.h"
#include "sweep/comparison.h"

namespace delquad {

int compare_command(const CompareArguments& arguments) {
  const Comparison comparison = compare_records(read_records(arguments.before), read_records(arguments.after),
                                                arguments.metrics, arguments.tolerance);
  fmt::print("{}", to_text(comparison));
  return comparison.regressed() ? kRegression : kDone;
}

}  // namespace delquad
