// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "delquad/fields.h"
#include "geometry/planar/planar_model.h"

// This header triangulates a domain in its metric. The flat plane of a metric is made from this.

namespace delquad {

/// A side of triangles on a curve.
struct CurveSegment {
  int piece;  ///< index into PlanarDomain::pieces
  std::array<int, 2> nodes;
  std::array<double, 2> t;  ///< of the piece's shape
};

/// Where a length along a bend was shortened most.
struct ShortenedLength {
  Vec2 at;
  double from = 0, to = 0;  ///< 0: nowhere
};

/// A triangulation of a planar domain that is fine where its metric changes, and Delaunay in it.
struct MetricMesh {
  Mesh fine;                           ///< triangles of all regions, which share their points
  std::vector<Tensor2> metric;         ///< at each point, within its limits
  std::vector<CurveSegment> segments;  ///< of all curves
  double complexity = 0;
  double scale = 1;  ///< of the tensors that were given, for the complexity
  ShortenedLength shortened;
  bool is_isotropic = false;  ///< whether these have no directions, within their limits
};

/// `spec`: with a largest length. `domain`: with its curves as coarse as they may be; its nodes come first,
/// in their order. Throws InputError for what is no metric, with the place and the tensor, and for more quads
/// than are allowed.
MetricMesh resolve_metric(const PlanarDomain& domain, const MetricFunction& metric, const MetricSpec& spec,
                          long long max_elements);

}  // namespace delquad
