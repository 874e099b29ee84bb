// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "delquad/fields.h"
#include "smoothing/cvt/bounded_voronoi.h"
#include "smoothing/cvt/lp_energy.h"
#include "smoothing/cvt/moving_delaunay.h"

// This header has the Lp energy of a patch and its minimization. Lp-CVT uses it.

namespace delquad {

/// Dimensionless Lp energy of a patch's points as a function of the inner ones:
///
///     F = (p + 1) 2^p / (2 N) sum over seeds of integral over the cell of |y - x|_p^p / delta'(x)^(p + 2) dy
///
/// N is the integral of 1/delta'^2 over the patch; F is 1 if all cells are squares of side delta' along the
/// cross. The cross is fixed at the seeds of the last hold_frames(). There, log delta' is linear with the
/// gradient by the triangulation.
///
/// For a density of points of 1/h^2, F is the integral of h^p / delta'^(p + 2), which is least for h
/// proportional to delta' [levy2010, baudouin2014]. This needs the derivative of delta' in the gradient.
/// Seeds with fixed weights would settle at widths of delta'^(1 + 2/p).
class CvtProblem {
 public:
  /// Takes an even p from 2 to 16; otherwise throws InputError. hold_frames() must come before other calls.
  CvtProblem(MovingDelaunay delaunay, int p);

  /// Takes cross and size at the current points. The size must be positive there.
  void hold_frames(const CrossField& cross, const ParametricSize& size);

  /// Returns the number of inner points, which are the variables.
  int n_free() const { return delaunay_.n_points() - delaunay_.n_boundary(); }
  /// Returns the inner points, in the parameter plane.
  std::vector<Vec2> seeds() const;
  /// Moves the seeds, n_free() of them, and returns F; nothing if the places are not admissible
  /// (MovingDelaunay::move_to, BoundedVoronoi::build). If the seeds are already there, it costs nothing.
  std::optional<double> evaluate(std::span<const Vec2> seeds);
  /// Returns dF/dx for each seed at the last evaluation.
  std::span<const Vec2> gradient() const;
  /// Returns delta' at the seeds of the last hold_frames(), the unit of their steps.
  std::span<const double> lengths() const;
  /// Returns the unit of F in which its second derivatives by positions over lengths() are about 1 on a
  /// lattice of the wanted size.
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
  std::vector<double> length_;  ///< delta' of each point
  double squares_ = 0;          ///< N in the energy
  std::vector<Vec2> gradient_;
  std::optional<double> last_;  ///< F at the seeds, if known
};

enum class MinimiserTermination {
  kConverged,   ///< by a tolerance
  kIterations,  ///< limit of iterations
  kStuck        ///< no admissible step lowers the energy
};

struct MinimiserOptions {
  int iterations = 25;               ///< limit of iterations
  double function_tolerance = 1e-5;  ///< converged if a step lowers F by less than this times F; >= 0
  double gradient_tolerance = 0;     ///< converged if no derivative by a seed, in newton_scale(), is larger
};

/// An evaluation of the energy.
struct EnergySample {
  int frames = 0;         ///< number of earlier hold_frames()
  double energy = 0;      ///< NaN: the places were refused
  bool accepted = false;  ///< whether the seeds continued from there
};

struct MinimiserOutcome {
  MinimiserTermination termination = MinimiserTermination::kConverged;
  int iterations = 0;        ///< accepted steps
  double gradient_norm = 0;  ///< largest derivative by a seed at the end, in newton_scale()
};

/// Lowers the energy of a problem with fixed frames, by L-BFGS with a line search for the strong Wolfe
/// conditions (Ceres). A refused place shortens the step. The problem ends evaluated at the best seeds found.
/// Appends all evaluations to `samples`; the first one is at the current seeds, which are admissible.
MinimiserOutcome minimise_cells(CvtProblem& problem, const MinimiserOptions& options,
                                std::vector<EnergySample>& samples);

/// Returns the largest derivative of F by a seed's position over lengths(), in newton_scale().
double scaled_gradient_norm(const CvtProblem& problem);

}  // namespace delquad
