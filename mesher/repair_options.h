#pragma once

#include "delquad/options.h"

namespace delquad {

/// What is done beside the stages of a pipeline, but for the last on surfaces.
struct RepairOptions {
  bool part_twins = true;  ///< after each stage: see part_twins()
  /// At the end, after a treatment: quads that are bad in space slide over the surface.
  bool lift_bad_quads = true;
  bool refine_unsound = true;  ///< after that: see refine_unsound()
  bool keep_given = true;      ///< see keep_better(), and hold_worst() in stages.cpp
};

OptionGroup repair_group();
RepairOptions repair_options(const Options& options);

}  // namespace delquad
