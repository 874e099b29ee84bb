#pragma once

#include <memory>
#include <vector>

#include "delquad/mesher.h"

namespace delquad {

/// A curve of a planar domain from a node to another one. At these it ends, or others meet it.
struct DomainCurve {
  std::shared_ptr<const Curve> shape;
  double from = 0, to = 1;  ///< parameters at the ends
  std::vector<int> nodes;   ///< along it, ends included: indices of points of Preparation::boundary
};

/// The curves of a planar model. There are none if lines were given, and in the plane of a metric.
std::vector<DomainCurve> domain_curves(const Prepared& prepared);

}  // namespace delquad
