#pragma once

#include "delquad/options.h"
#include "smoothing/cvt/smooth_points.h"

namespace delquad {

enum class SmoothingMethod { kLpCvt, kLloyd };

/// What smoothing can be told.
struct CvtOptions {
  SmoothingMethod method = SmoothingMethod::kLpCvt;
  SmoothingOptions smoothing;
};

OptionGroup smoothing_group();
CvtOptions cvt_options(const Options& options);

}  // namespace delquad
