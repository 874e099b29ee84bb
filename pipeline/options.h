#pragma once

#include "algorithms/cleanup/cleanup.h"
#include "algorithms/insertion/frontal_mesher.h"
#include "algorithms/insertion/point_placement.h"
#include "algorithms/recombination/treatment.h"
#include "smoothing/cvt/smooth_points.h"
#include "smoothing/optimisation/optimisation_options.h"

namespace delquad {

enum class Treatment { kNone, kPaper };
enum class SmoothingMethod { kLpCvt, kLloyd };

/// What surfaces get beside the stages of a pipeline.
struct RepairOptions {
  bool part_twins = true;  ///< after each stage: see part_twins()
  /// At the end, after a treatment: quads that are bad in space slide over the surface.
  bool lift_bad_quads = true;
};

/// What the stages of a pipeline can be told.
struct MeshingOptions {
  FrontalOptions frontal;
  LinfOptions linf;
  Treatment treatment = Treatment::kPaper;  ///< after matching
  TreatmentOptions treatment_options;
  SmoothingMethod smoothing = SmoothingMethod::kLpCvt;
  SmoothingOptions smoothing_options;
  CleanupOptions cleanup;
  OptimisationOptions optimisation;
  RepairOptions repair;
  long long max_elements = 50'000'000;  ///< refuse sizes whose integral of dA/delta^2 is larger
  bool keep_going = false;  ///< leave faces out that cannot be meshed, instead of refusing the model

  /// Those of insertion. max_elements bounds what is inserted, too: a quad mesh has about as many points as
  /// quads.
  FrontalOptions insertion() const {
    constexpr long long kPointsPerElement = 4;
    FrontalOptions options = frontal;
    options.max_points = kPointsPerElement * max_elements;
    return options;
  }
};

}  // namespace delquad
