// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <functional>
#include <limits>
#include <vector>

#include "base/budget.h"
#include "smoothing/surface/surface_tracks.h"

// This header moves vertices on surfaces in space. The last repairs use it.

namespace delquad {

/// Ball in space, with its radius in model units; only quads with a corner in it are lifted.
struct LiftedBall {
  Vec3 centre = {};
  double radius = std::numeric_limits<double>::infinity();
};

/// Lifts the worst quads of a surface in space (own method). While quads below `eta`, in [0, 1], improve,
/// their vertices slide on the true faces and along curves to raise the worst quad around. They may leave the
/// fine triangles of the parameter plane, where a face is narrower than the triangles are exact. The least
/// eta around a vertex never falls. Edges at a node on a curve keep half of the shortest initial length
/// around it. `places` has the places of the tracks' vertices, and is updated. Each tried place costs one of
/// `trials`, on CAD ten; the work ends when they are spent. Returns the number of moved vertices.
int lift_worst_on_surface(SurfaceTracks& tracks, std::vector<Vec3>& places, double eta, int max_sweeps,
                          Budget& trials, const LiftedBall& ball = {});

/// Limits for quads in space, which fail if they exceed one.
struct SpaceLimits {
  const SizeField& size;
  QuadLimits kept;  ///< limits of sides and eta that moves and edits keep
  /// Returns by how much a quad with this size, a length, is beyond all limits, as logarithms; 0: it keeps
  /// them.
  std::function<double(const std::array<Vec3, 4>& corners, double size)> excess;
};

/// Moves vertices as lift_worst_on_surface(), but of quads that fail by `limits`. Returns the number of moved
/// vertices. Vertices of such a quad move if fewer quads fail then, at a small loss of eta. No eta falls
/// below the kept eta or, if it was lower, below its old value or the least of all.
int repair_failing_on_surface(SurfaceTracks& tracks, std::vector<Vec3>& places, const SpaceLimits& limits,
                              int max_sweeps, Budget& trials);

}  // namespace delquad
