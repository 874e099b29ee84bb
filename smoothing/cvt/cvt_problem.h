#pragma once

#include <optional>
#include <span>
#include <vector>

#include "fields/cross_field.h"
#include "fields/size_field.h"
#include "smoothing/cvt/bounded_voronoi.h"
#include "smoothing/cvt/lp_energy.h"
#include "smoothing/cvt/moving_delaunay.h"

namespace delquad {

/// The Lp energy of a patch's points as a function of the inner ones, without dimension:
///
///     F = (p + 1) 2^p / (2 area) * sum over seeds of integral over the cell of (|y - x|_p / delta'(x))^p dy
///
/// 1 when all cells are squares of side delta' along the cross field. Cross and size are held where the
/// seeds were when they were last taken.
///
/// Differs from [levy2010] and [baudouin2014], whose weight delta'^-(p + 2) varies in space: a weight that
/// goes with its seed balances two neighbours' cells when weight * width^p is the same for both, so that
/// widths follow delta' for delta'^-p.
class CvtProblem {
 public:
  CvtProblem(MovingDelaunay delaunay, int p);

  /// Takes cross and size at the points as they are.
  void hold_frames(const CrossField& cross, const ParametricSize& size);

  int n_free() const { return delaunay_.n_points() - delaunay_.n_boundary(); }
  std::vector<Vec2> seeds() const;
  /// Moves the seeds there; F, or nothing where that is no admissible place for them (see
  /// MovingDelaunay::move_to and BoundedVoronoi::build). Costs nothing where they are already.
  std::optional<double> evaluate(std::span<const Vec2> seeds);
  /// dF/dx of each seed, of the last evaluation.
  std::span<const Vec2> gradient() const;
  /// A length: the root of the patch's area a point.
  double spacing() const { return spacing_; }
  /// F in such units that its second derivatives by positions over spacing() are about 1 on a regular
  /// lattice.
  double newton_scale() const;

  int p() const { return p_; }
  const MovingDelaunay& delaunay() const { return delaunay_; }
  const BoundedVoronoi& cells() const { return cells_; }
  const SeedFrames& frames() const { return frames_; }

 private:
  MovingDelaunay delaunay_;
  BoundedVoronoi cells_;
  SeedFrames frames_;
  LpEnergy energy_;
  int p_;
  double area_, spacing_;
  std::vector<Vec2> gradient_;
  std::optional<double> last_;  ///< F where the seeds are, when it is known
};

}  // namespace delquad
