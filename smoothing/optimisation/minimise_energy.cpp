#include "smoothing/optimisation/minimise_energy.h"

#include <ceres/gradient_problem.h>
#include <ceres/gradient_problem_solver.h>

#include "base/cancel.h"
#include "delquad/error.h"

namespace delquad {

namespace {

/// Steps that L-BFGS remembers: more of them cost as much time as they save.
constexpr int kMemory = 5;
/// The descent ends when a step gains less than this part of the energy.
constexpr double kLeastGain = 1e-5;

template <class Vec>
class CeresEnergy final : public ceres::FirstOrderFunction {
 public:
  explicit CeresEnergy(const QuadEnergy<Vec>& energy) : energy_(energy) {}
  bool Evaluate(const double* parameters, double* cost, double* gradient) const override {
    // Nothing may be thrown through the solver. It gives up at what cannot be evaluated.
    try {
      return energy_.evaluate(parameters, *cost, gradient);
    } catch (const Cancelled&) {
      return false;
    }
  }
  int NumParameters() const override { return energy_.variables(); }

 private:
  const QuadEnergy<Vec>& energy_;
};

}  // namespace

template <class Vec>
EnergyDescent minimise(const QuadEnergy<Vec>& energy, int max_iterations) {
  EnergyDescent descent;
  descent.x.assign(energy.variables(), 0.0);
  if (descent.x.empty()) return descent;
  ceres::GradientProblemSolver::Options options;
  options.line_search_direction_type = ceres::LBFGS;
  options.line_search_type = ceres::WOLFE;
  options.max_lbfgs_rank = kMemory;
  options.use_approximate_eigenvalue_bfgs_scaling = true;
  options.max_num_iterations = max_iterations;
  options.function_tolerance = kLeastGain;
  options.gradient_tolerance = 0;
  options.parameter_tolerance = 1e-9;
  options.logging_type = ceres::SILENT;
  ceres::GradientProblemSolver::Summary report;
  const ceres::GradientProblem problem(new CeresEnergy<Vec>(energy));
  ceres::Solve(options, problem, descent.x.data(), &report);
  check_cancelled();
  descent.iterations = static_cast<int>(report.iterations.size());
  descent.evaluations = report.num_cost_evaluations + report.num_gradient_evaluations;
  descent.energy_before = report.initial_cost;
  descent.energy_after = report.final_cost;
  // What the solver left may be its last trial, of infinite energy.
  double value = 0;
  if (!energy.evaluate(descent.x.data(), value, nullptr)) descent.x.assign(descent.x.size(), 0.0);
  return descent;
}

template EnergyDescent minimise(const QuadEnergy<Vec2>&, int);
template EnergyDescent minimise(const QuadEnergy<Vec3>&, int);

}  // namespace delquad
