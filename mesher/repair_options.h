#pragma once

#include "delquad/options.h"

namespace delquad {

/// What is done beside the stages of a pipeline: see finish_steps().
struct RepairOptions {
  bool part_twins = true;
  bool lift_bad_quads = true;
  bool flat_corners = true;
  bool across_cuts = true;
  bool refine_unsound = true;
  bool keep_given = true;  ///< see hold_worst() in stages.cpp, too
};

OptionGroup repair_group();
RepairOptions repair_options(const Options& options);

}  // namespace delquad
