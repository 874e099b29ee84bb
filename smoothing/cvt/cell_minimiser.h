#pragma once

#include <memory>
#include <vector>

#include "smoothing/cvt/cvt_problem.h"

namespace delquad {

enum class MinimiserTermination {
  kConverged,   ///< by a tolerance
  kIterations,  ///< all that were allowed
  kStuck        ///< no admissible step that lowers the energy was found
};

struct MinimiserOptions {
  int iterations = 60;               ///< at most
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

/// A way to lower the energy of a problem whose frames are held.
class CellMinimiser {
 public:
  virtual ~CellMinimiser() = default;
  /// Leaves the problem evaluated at the best seeds found. Appends to `samples` each evaluation made; the
  /// first is at the seeds as they are, and admissible.
  virtual MinimiserOutcome minimise(CvtProblem& problem, const MinimiserOptions& options,
                                    std::vector<EnergySample>& samples) const = 0;
};

/// L-BFGS with a line search for the strong Wolfe conditions, by Ceres. A place that is refused shortens
/// the step.
std::unique_ptr<CellMinimiser> make_lbfgs_minimiser();

/// Lloyd's iteration: every seed goes to the place in its own cell where the cell's energy is least. It
/// knows nothing of how the neighbours' cells change, which for p > 2 is part of the gradient: the energy
/// may rise.
std::unique_ptr<CellMinimiser> make_lloyd_minimiser();

/// The largest derivative of F by a seed's position over lengths(), in newton_scale().
double scaled_gradient_norm(const CvtProblem& problem);

}  // namespace delquad
