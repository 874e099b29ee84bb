#pragma once

#include "delquad/options.h"

namespace delquad {

/// How the curves of surfaces get their numbers of edges.
struct CurveOptions {
  /// What an irregular vertex less is worth, in quads times eta, see agree_on_counts(); 0: the size alone
  /// counts.
  double agreement = 3;
};

OptionGroup curve_group();
CurveOptions curve_options(const Options& options);

}  // namespace delquad
