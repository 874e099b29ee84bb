#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/counters.h"
#include "delquad/error.h"
#include "delquad/extend.h"
#include "delquad/model.h"
#include "patches/all_patches.h"

namespace delquad {

/// What was to be inserted is more than max_elements allow; the message does not say where that was asked
/// for.
class TooManyPoints : public InputError {
 public:
  using InputError::InputError;
};

/// Edits of whole patches that were taken back, because they left two quads around a tube.
struct DiscardSummary {
  int treatments = 0;  ///< patches whose matching was relocated only
  int cleanups = 0;    ///< patches that stayed as they were
};

template <>
struct Counters<DiscardSummary> {
  using S = DiscardSummary;
  static constexpr const char* step = "discarded";
  static constexpr auto all =
      std::tuple{counter("treatments", &S::treatments), counter("cleanups", &S::cleanups)};
};

/// max_elements bounds what is inserted, too: a quad mesh has about as many points as quads.
inline constexpr long long kPointsPerElement = 4;

}  // namespace delquad
