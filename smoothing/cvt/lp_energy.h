// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "delquad/fields.h"
#include "smoothing/cvt/bounded_voronoi.h"
#include "smoothing/cvt/moving_delaunay.h"

// This header has the Lp energy of a bounded Voronoi diagram. Lp-CVT minimizes it.

namespace delquad {

/// Frames in which seeds, boundary points included, measure their cells. They stay while the seeds move,
/// except that a seed at x has weight * exp(slope.(x - from)).
struct SeedFrames {
  std::vector<Vec2> axis;      ///< unit vector along one direction of the cross
  std::vector<double> weight;  ///< > 0
  std::vector<Vec2> slope;     ///< gradient of log weight
  std::vector<Vec2> from;      ///< place of the seed when `weight` was taken
};

/// Throws InputError unless p is even, from 2 to 16.
void check_norm(int p);

/// The Lp energy of centroidal Voronoi tessellations [levy2010], in the patch's parameter plane:
///
///     F = sum over seeds i of weight_i * integral over cell i of |t1.(y - x_i)|^p + |t2.(y - x_i)|^p dy
///
/// with t1 = axis_i, t2 across it and weight_i at x_i, over the cells of the bounded Voronoi diagram. F has
/// continuous first derivatives, also if the triangulation changes.
class LpEnergy {
 public:
  /// Throws as check_norm().
  explicit LpEnergy(int p);

  /// Returns F. `gradient` gets its exact derivative by each point, with fixed axes: through corners of
  /// cells, also on the boundary, and weights. It is 0 at boundary points, which do not move. Returns NaN if
  /// floating point has no diagram in `cells`.
  double evaluate(const MovingDelaunay& delaunay, const BoundedVoronoi& cells, const SeedFrames& frames,
                  std::vector<Vec2>& gradient);

 private:
  int p_;
  std::vector<double> energy_;   // by seed
  std::vector<Vec2> by_centre_;  // by corner 3 t + k: derivative of its seed by the circumcenter; later the
                                 // resulting derivative by the seed
  std::vector<Vec2> by_clip_;    // by clip: derivatives of the cells at `from` and `to`
};

}  // namespace delquad
