#pragma once

#include "algorithms/insertion/frontal_mesher.h"

namespace delquad {

/// What insertion can be told.
struct InsertionOptions {
  FrontalOptions frontal;
  LinfOptions linf;
};

OptionGroup insertion_group();
InsertionOptions insertion_options(const Options& options);

}  // namespace delquad
