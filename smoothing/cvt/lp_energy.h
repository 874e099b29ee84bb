#pragma once

#include <vector>

#include "delquad/fields.h"
#include "smoothing/cvt/bounded_voronoi.h"
#include "smoothing/cvt/moving_delaunay.h"

namespace delquad {

/// What each seed measures its cell with, boundary points included: held while the seeds move, but for the
/// weight, which a seed at x has weight * exp(slope.(x - from)) times.
struct SeedFrames {
  std::vector<Vec2> axis;      ///< unit vector along one direction of the cross
  std::vector<double> weight;  ///< > 0
  std::vector<Vec2> slope;     ///< gradient of log weight
  std::vector<Vec2> from;
};

/// Even, 2 to 16. Throws InputError for others.
void check_norm(int p);

/// The Lp energy of centroidal Voronoi tessellations [levy2010], in the patch's parameter plane:
///
///     F = sum over seeds i of weight_i * integral over cell i of |t1.(y - x_i)|^p + |t2.(y - x_i)|^p dy
///
/// with t1 = axis_i, t2 across it and weight_i that at x_i, over the cells of the bounded Voronoi diagram. F
/// has continuous first derivatives, also where the triangulation changes.
class LpEnergy {
 public:
  explicit LpEnergy(int p);

  /// F, and its exact derivative by each point's position, axes held: through the corners of the cells, on
  /// the boundary included, and the weights. That of boundary points is 0: they do not move. NaN where
  /// `cells` holds no diagram in floating point.
  double evaluate(const MovingDelaunay& delaunay, const BoundedVoronoi& cells, const SeedFrames& frames,
                  std::vector<Vec2>& gradient);

 private:
  int p_;
  std::vector<double> energy_;   // of each seed
  std::vector<Vec2> by_centre_;  // of each corner 3 t + k: its seed's derivative by the circumcentre;
                                 // then what comes of it for the seed
  std::vector<Vec2> by_clip_;    // of each clip: the derivatives of the cells at from, to
};

}  // namespace delquad
