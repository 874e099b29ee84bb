// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "delquad/model.h"

// This header has curves that tell how they were made. Model files use it.

namespace delquad {

/// A curve that tells how it was made.
class DefinedCurve : public Curve {
 public:
  /// Returns a text that no other curve has, such as "arc" with its center, radius and angles. Numbers keep
  /// every bit.
  virtual std::string definition() const = 0;
};

}  // namespace delquad
