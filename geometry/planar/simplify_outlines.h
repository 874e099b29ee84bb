// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <vector>

#include "delquad/error.h"
#include "delquad/model.h"

// This header removes points of polylines. The preparation uses it.

namespace delquad {

/// Returns the largest distance, a length, of a removed point of a curve (index) from the remaining polyline.
using OutlineTolerance = std::function<double(int curve, const Vec3& at)>;

/// Returns the model with fewer points on polylines of data, or on all polylines, by topology-preserving
/// simplification [dyken2009] of CGAL. Removed points lie within their tolerance of the rest, and outlines do
/// not touch or cross each other more than before. Ends, points of several curves, and three points of a ring
/// stay. A warning for each curve tells the number of its points and the largest distance.
PlanarModel simplify_outlines(PlanarModel model, const OutlineTolerance& tolerance, bool all,
                              std::vector<Warning>& warnings);

}  // namespace delquad
