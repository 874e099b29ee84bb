// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "algorithms/layout/field_lines.h"
#include "algorithms/layout/patch_layout.h"

// This header makes the pieces of a layout and their costs, in quads times eta. The layout search uses it.

namespace delquad {

/// Costs of a quad without any eta, before relocation, and of a size deviation.
inline constexpr double kLoss = 0.5, kDeviation = 1.5;
/// Irregular vertices beyond the necessary ones in a piece without a pattern.
inline constexpr int kMixed = 4;
/// Cost of an odd piece, which has no quads.
inline constexpr double kNever = 1e30;

/// Returns the corners of a rim minus its concave turns; 4 for a grid.
int corners_of(const Rim& rim);
/// Returns 2 - quads at each vertex: 1 at a corner, 0 on a side, negative if concave.
std::vector<int> turns_of(const Rim& rim);
/// Returns whether no vertex is concave.
bool is_convex(const Rim& rim);
/// Returns whether a rim has two to five corners and no concave one.
bool is_polygon(const Rim& rim);

/// Returns the two rims into which a line with these inner vertices cuts one, or the rim into which it joins
/// two.
std::vector<Rim> cut_along(std::span<const Rim> rims, const FieldLine& line, std::span<const int> row);

/// Returns the estimated cost of the irregular vertices of a piece (own rule); each costs `weight`. It is
/// kNever for an odd rim.
double cost_of(const Rim& rim, double weight);
/// Returns the cost of a piece whose sides may change their numbers of edges (own rule). It depends on the
/// distance to numbers that close a grid or a star.
double cost_of_closed(const Rim& rim, double weight);
/// Returns twice the distance from the start of side i to the foot of a star's arm on it, for 3 or 5 sides.
/// It is below 2 if there is no star.
int foot_of(std::span<const int> sides, std::size_t i);

}  // namespace delquad
