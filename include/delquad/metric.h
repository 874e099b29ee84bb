#pragma once

#include <optional>
#include <vector>

#include "delquad/fields.h"
#include "delquad/mesher.h"

namespace delquad {

/// A metric by its values.
struct NodalMetric {
  Mesh mesh;
  std::vector<Tensor2> at;  ///< its points
};

/// The metric of a planar domain as its meshes follow it, at the points of triangles with lines along all
/// curves; nothing where there is none.
std::optional<NodalMetric> followed_metric(const Prepared& prepared);

}  // namespace delquad
