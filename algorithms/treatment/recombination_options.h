#pragma once

#include <string>

#include "algorithms/treatment/treatment.h"
#include "delquad/options.h"

namespace delquad {

enum class Treatment { kNone, kPaper };

/// What recombination can be told.
struct RecombinationOptions {
  std::string solver = "primal-dual";  ///< of matching_solver_names(); for the counts on curves, too
  Treatment treatment = Treatment::kPaper;
  TreatmentOptions treatment_options;
};

OptionGroup recombination_group();
RecombinationOptions recombination_options(const Options& options);

}  // namespace delquad
