#include "algorithms/treatment/recombination_options.h"

#include "base/option_table.h"
#include "delquad/matching.h"

namespace delquad {
namespace {

const OptionTable<RecombinationOptions>& recombination_table() {
  static const auto all =
      OptionTable<RecombinationOptions>("recombination", "options of B and G")
          .add({.name = "solver",
                .help = "what matches triangles, and makes counts on curves even",
                .names = matching_solver_names},
               &RecombinationOptions::solver)
          .choice({.name = "treatment", .help = "after the matching"}, &RecombinationOptions::treatment,
                  std::vector<std::pair<std::string, Treatment>>{{"none", Treatment::kNone},
                                                                 {"paper", Treatment::kPaper}});
  return all;
}

}  // namespace

OptionGroup recombination_group() { return recombination_table().group(); }
RecombinationOptions recombination_options(const Options& options) {
  return recombination_table().read(options);
}

}  // namespace delquad
