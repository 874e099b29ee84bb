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

/// Distance, over the model's diagonal, within which ends of curves are one node, since coordinates often
/// have seven digits.
inline constexpr double kJoinTolerance = 1e-7;

/// A compulsory node inside of a curve, with its parameter.
struct CurveStop {
  double t;
  int node;
};

/// Nodes that the curves of a model share.
struct ModelChain {
  std::vector<Vec2> nodes;  ///< ends, corners and points; of several within the tolerance, the first one
  std::vector<std::array<int, 2>> curve_ends;  ///< nodes at the start and end of each curve
  /// For each curve, ascending, its corners, and the places where other curves end on it or cross it.
  std::vector<std::vector<CurveStop>> stops;
  std::vector<int> point_nodes;  ///< nodes of the model's points
  /// The model's loops. A loop that is listed twice, once with a region (the filling of a hole), occurs once.
  std::vector<ModelLoop> loops;
};

/// Returns the nodes of a model (own method). Each loop must be closed and in one piece; it may pass a node
/// several times. Ends, corners and points within kJoinTolerance are one node. Throws InputError for open
/// loops, curves without length or with points that are not finite, and a model without loops.
ModelChain chain_model(const PlanarModel& model);

/// Returns a curve's label in messages: its name or number, and its place in the file.
std::string curve_label(const PlanarModel& model, int curve);
/// Returns a point's label in messages.
std::string point_label(const PlanarModel& model, int point);

/// Returns the bounding box of the curves, by so many chords >= 1 each.
Box<Vec2> box_of(const PlanarModel& model, int chords);

}  // namespace delquad
