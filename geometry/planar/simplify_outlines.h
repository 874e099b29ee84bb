#pragma once

#include <vector>

#include "delquad/error.h"
#include "delquad/model.h"
#include "geometry/planar/planar_model.h"

namespace delquad {

/// A turn by more is a corner of a simplified polyline, with a node (radians).
inline constexpr double kSimplifiedCorner = 0.6;

/// The model with polylines of fewer points, in place of those of data, or of all: the points that go lie
/// within the tolerance at their place of what stays, and no outlines touch or cross that did not. Ends,
/// points of several curves, and four points of a ring stay. Nodes are compulsory at sharp turns alone. By
/// topology-preserving simplification [Dyken, Daehlen, Sevaldrud 2009], as CGAL has it. Warnings tell of each
/// curve how many points went, and of rings that are narrower than their tolerance.
PlanarModel simplify_outlines(PlanarModel model, const PointSize& tolerance, bool all,
                              std::vector<Warning>& warnings);

}  // namespace delquad
