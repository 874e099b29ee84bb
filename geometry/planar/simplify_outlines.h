// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <vector>

#include "delquad/error.h"
#include "delquad/model.h"

// This header removes points of polylines. The preparation uses it.

namespace delquad {

/// How far a point of a curve, by its index, may lie from what stays.
using OutlineTolerance = std::function<double(int curve, const Vec3& at)>;

/// Returns the model with polylines of fewer points, in place of polylines of data, or of all. The points
/// that go lie within their tolerance of the rest, and no outlines touch or cross that did not. Ends, points
/// of several curves, and three points of a ring stay. By topology-preserving simplification [dyken2009], as
/// CGAL has it. Warnings tell of each curve how many points stay, and how far the others are from it.
PlanarModel simplify_outlines(PlanarModel model, const OutlineTolerance& tolerance, bool all,
                              std::vector<Warning>& warnings);

}  // namespace delquad
