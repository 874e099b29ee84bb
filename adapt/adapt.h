#pragma once

#include <vector>

#include "delquad/adapt.h"

namespace delquad {

/// The integral of sqrt(det M), by the values at points.
double complexity_of(const Mesh& mesh, const std::vector<Tensor2>& metric);

/// What a planar mesh bounds, with names that are indices into lists of the mesh: of curves (one more: sides
/// that have no line), regions and named points. Curves end where the outline turns by more than kCornerTurn
/// (degrees), at the ends of straight sides, and where other things meet.
PlanarModel trace_mesh(const Mesh& mesh);
inline constexpr double kCornerTurn = 40;

}  // namespace delquad
