// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "delquad/model.h"

// This header has curves that know their definition. Model files use it.

namespace delquad {

/// A curve that knows its definition.
class DefinedCurve : public Curve {
 public:
  /// Returns a unique text of the curve, such as "arc" with its center, radius and angles. Numbers keep every
  /// bit.
  virtual std::string definition() const = 0;
};

}  // namespace delquad
