// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "delquad/fields.h"
#include "geometry/planar/planar_model.h"

// This header triangulates a domain in its metric. The flat plane of a metric is made from this.

namespace delquad {

/// A side of triangles that lies on a curve.
struct CurveSegment {
  int piece;  ///< index into PlanarDomain::pieces
  std::array<int, 2> nodes;
  std::array<double, 2> t;  ///< parameters of both nodes on the shape of the piece
};

/// The length along a bend that was shortened most, in lengths of the metric.
struct ShortenedLength {
  Vec2 at;
  double from = 0, to = 0;  ///< before and after; 0: none was shortened
};

/// A triangulation of a planar domain, fine where its metric changes, and Delaunay in the metric.
struct MetricMesh {
  Mesh fine;                           ///< triangles of all regions, which share their points
  std::vector<Tensor2> metric;         ///< at each point, within its limits
  std::vector<CurveSegment> segments;  ///< of all curves
  double complexity = 0;
  double scale = 1;  ///< factor of the given tensors, for the complexity
  ShortenedLength shortened;
  bool is_isotropic = false;  ///< within their limits, the tensors have no directions
};

/// Returns the triangulation of a domain in its metric. `spec` has a largest length. `domain` has curves that
/// are as coarse as possible; its nodes come first, in their order. Throws InputError, with the place and the
/// tensor, for tensors that are no metric, and for more quads than `max_elements`. Own method.
MetricMesh resolve_metric(const PlanarDomain& domain, const MetricFunction& metric, const MetricSpec& spec,
                          long long max_elements);

}  // namespace delquad
