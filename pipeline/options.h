#pragma once

#include "algorithms/insertion/frontal_mesher.h"
#include "algorithms/insertion/point_placement.h"
#include "algorithms/recombination/treatment.h"

namespace delquad {

enum class Treatment { kNone, kPaper };

/// What the stages of a pipeline can be told.
struct MeshingOptions {
  FrontalOptions frontal;
  LinfOptions linf;
  Treatment treatment = Treatment::kPaper;  ///< after matching
  TreatmentOptions treatment_options;
  long long max_elements = 50'000'000;  ///< refuse sizes whose integral of dA/delta^2 is larger
};

}  // namespace delquad
