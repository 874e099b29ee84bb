#pragma once

#include <optional>
#include <span>
#include <vector>

#include "delquad/fields.h"
#include "smoothing/cvt/bounded_voronoi.h"
#include "smoothing/cvt/lp_energy.h"
#include "smoothing/cvt/moving_delaunay.h"

namespace delquad {

/// The Lp energy of a patch's points as a function of the inner ones, without dimension:
///
///     F = (p + 1) 2^p / (2 N) * sum over seeds of integral over the cell of |y - x|_p^p / delta'(x)^(p + 2)
///     dy
///
/// with N the integral of 1/delta'^2 over the patch: 1 when all cells are squares of side delta' along the
/// cross field. The cross is held where the seeds were when it was last taken; log delta' is linear around
/// there, with the gradient that the triangulation gives.
///
/// A density of points of 1/h^2 makes F the integral of h^p / delta'^(p + 2), least for h in proportion to
/// delta' [levy2010, baudouin2014]. That needs the derivative of delta' in the gradient: seeds that carry
/// their weights along would settle at widths of delta'^(1 + 2/p).
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
  /// delta' where each seed was when the frames were taken: the unit to measure its way in.
  std::span<const double> lengths() const;
  /// F in such units that its second derivatives by positions over lengths() are about 1 on a lattice of
  /// the wanted size.
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
  double squares_ = 0;          ///< N above
  std::vector<Vec2> gradient_;
  std::optional<double> last_;  ///< F where the seeds are, when it is known
};

enum class MinimiserTermination {
  kConverged,   ///< by a tolerance
  kIterations,  ///< all that were allowed
  kStuck        ///< no admissible step that lowers the energy was found
};

struct MinimiserOptions {
  int iterations = 25;               ///< at most
  double function_tolerance = 1e-5;  ///< converged when a step lowers F by less than this times F
  double gradient_tolerance = 0;     ///< converged when no seed's derivative, in newton_scale(), is larger
};

/// One evaluation of the energy.
struct EnergySample {
  int frames = 0;         ///< how many times cross and size had been taken before
  double energy = 0;      ///< NaN: the place was refused
  bool accepted = false;  ///< whether the seeds went on from there
};

struct MinimiserOutcome {
  MinimiserTermination termination = MinimiserTermination::kConverged;
  int iterations = 0;        ///< accepted steps
  double gradient_norm = 0;  ///< the largest derivative by a seed at the end, in newton_scale()
};

/// Lowers the energy of a problem whose frames are held, by L-BFGS with a line search for the strong Wolfe
/// conditions (Ceres). A place that is refused shortens the step. Leaves the problem evaluated at the best
/// seeds found. Appends to `samples` each evaluation made. The first is at the seeds as they are, and
/// admissible.
MinimiserOutcome minimise_cells(CvtProblem& problem, const MinimiserOptions& options,
                                std::vector<EnergySample>& samples);

/// The largest derivative of F by a seed's position over lengths(), in newton_scale().
double scaled_gradient_norm(const CvtProblem& problem);

}  // namespace delquad
