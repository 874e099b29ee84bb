// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <string>
#include <vector>

#include "base/box.h"
#include "geometry/planar/planar_model.h"

// This header finds the compulsory nodes of planar models. The pipeline, features, readers and writers and
// geometry use it.

namespace delquad {

/// Ends of curves of a loop that lie closer than this, relative to the model's diagonal, are one node. The
/// coordinates in a model are written with about seven digits.
inline constexpr double kJoinTolerance = 1e-7;

/// A compulsory node inside of a curve.
struct CurveStop {
  double t;
  int node;
};

/// How the curves of a model hang together.
struct ModelChain {
  std::vector<Vec2> nodes;                     ///< where curves join: the end point of the first curve listed
  std::vector<std::array<int, 2>> curve_ends;  ///< nodes at the start and end of each curve
  /// For each curve, ascending, its corners and the places where others end on it or stand across it.
  std::vector<std::vector<CurveStop>> stops;
  std::vector<int> point_nodes;  ///< of the model's points
  /// The model's loops. A loop listed twice, once with a region (the filling of a hole), stands once.
  std::vector<ModelLoop> loops;
};

/// Chains the curves of loops. Each loop must be closed and in one piece; it may pass a node several times.
/// Ends, corners and points nearer to each other than kJoinTolerance are one node. Throws InputError for open
/// loops, curves without length, a model without loops.
ModelChain chain_model(const PlanarModel& model);

/// Returns the curve as messages call it: its name or number, and where it was read.
std::string curve_label(const PlanarModel& model, int curve);
/// Returns the same for a point.
std::string point_label(const PlanarModel& model, int point);

/// Returns the bounding box of the curves, by so many chords each.
Box<Vec2> box_of(const PlanarModel& model, int chords);

}  // namespace delquad
