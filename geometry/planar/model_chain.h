#pragma once

#include <array>
#include <string>
#include <vector>

#include "geometry/planar/planar_model.h"

namespace delquad {

/// Ends of curves of a loop that lie closer than this, relative to the model's diagonal, are one node: the
/// coordinates in a model are written with about seven digits.
inline constexpr double kJoinTolerance = 1e-7;

/// The loops of a model, each checked to be one closed chain of curves.
struct ModelChain {
  std::vector<Vec2> nodes;                     ///< where curves join: the end point of the first curve listed
  std::vector<std::array<int, 2>> curve_ends;  ///< nodes at the start and end of each curve
  /// The model's loops. A loop listed twice, once with a region (the filling of a hole), stands once.
  std::vector<ModelLoop> loops;
};

/// Throws InputError for open loops, curves without length, curves that no loop uses, loops that share some
/// curves but not all.
ModelChain chain_model(const PlanarModel& model);

/// The curve as messages call it: its name or number, and where it was read.
std::string curve_label(const PlanarModel& model, int curve);

}  // namespace delquad
