// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <vector>

#include "delquad/mesher.h"

// This header has the curves of a planar domain. Programs that use the library call it.

namespace delquad {

/// A curve of a planar domain from a node to another one. At these it ends, or others meet it.
struct DomainCurve {
  std::shared_ptr<const Curve> shape;
  double from = 0, to = 1;  ///< parameters at the ends
  std::vector<int> nodes;   ///< indices of points of Preparation::boundary along it, ends included
};

/// Returns the curves of a planar model; none if lines were given, or in the plane of a metric.
std::vector<DomainCurve> domain_curves(const Prepared& prepared);

}  // namespace delquad
