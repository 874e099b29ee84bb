#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "algorithms/layout/field_lines.h"
#include "algorithms/layout/patch_layout.h"

/// The pieces of a layout: how cuts make them, and what they cost. Costs are in quads times eta.

namespace delquad {

/// The cost of a quad that lacks all of eta, before relocation, and of a size deviation.
inline constexpr double kLoss = 0.5, kDeviation = 1.5;
/// Irregular vertices beyond those necessary of a piece that no pattern fills.
inline constexpr int kMixed = 4;
/// Odd pieces have no quads.
inline constexpr double kNever = 1e30;

int corners_of(const Rim& rim);
std::vector<int> turns_of(const Rim& rim);
bool is_convex(const Rim& rim);
/// Whether it has two to five corners, none of them concave.
bool is_polygon(const Rim& rim);

/// The two rims that a row of vertices makes of one, or the one that it makes of two.
std::vector<Rim> cut_along(std::span<const Rim> rims, const FieldLine& line, std::span<const int> row);

/// Returns the cost of the irregular vertices of a piece, as far as its rim tells.
double cost_of(const Rim& rim, double weight);
/// The same if its sides can have other numbers of edges. It depends on how far they are from numbers with
/// which a grid or a star closes.
double cost_of_closed(const Rim& rim, double weight);
/// Twice the distance from the start of side i to the foot of the arm of a star there.
int foot_of(std::span<const int> sides, std::size_t i);

}  // namespace delquad
