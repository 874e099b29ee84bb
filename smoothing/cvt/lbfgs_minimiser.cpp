// SPDX-License-Identifier: GPL-3.0-or-later
#include <ceres/gradient_problem.h>
#include <ceres/gradient_problem_solver.h>

#include <algorithm>
#include <limits>

#include "base/cancel.h"
#include "delquad/error.h"
#include "smoothing/cvt/blocks.h"
#include "smoothing/cvt/cell_minimiser.h"

namespace delquad {
namespace {

/// F in newton_scale() as a function of the seeds' steps over lengths(). If the first step of a seed is
/// longer than one length, F is scaled down. Ceres would shorten it by the largest component, which depends
/// on the axes.
class ScaledEnergy final : public ceres::FirstOrderFunction {
 public:
  ScaledEnergy(CvtProblem& problem, std::vector<EnergySample>& samples)
      : problem_(problem), samples_(samples), start_(problem.seeds()), seeds_(start_) {}

  bool Evaluate(const double* parameters, double* cost, double* gradient) const override {
    std::optional<double> energy;
    // The solver passes no exceptions. It stops if an evaluation fails.
    try {
      energy = problem_.evaluate(seeds(parameters));
    } catch (const Cancelled&) {
      return false;
    }
    samples_.push_back({0, energy.value_or(std::numeric_limits<double>::quiet_NaN()), false});
    if (!energy) return false;
    if (scale_ == 0) scale_ = problem_.newton_scale() / std::max(1.0, scaled_gradient_norm(problem_));
    *cost = scale_ * *energy;
    if (gradient == nullptr) return true;
    const auto h = problem_.lengths();
    const auto g = problem_.gradient();
    parallel_blocks(g.size(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        gradient[2 * i] = scale_ * h[i] * g[i].x;
        gradient[2 * i + 1] = scale_ * h[i] * g[i].y;
      }
    });
    return true;
  }
  /// Returns the scale of the cost, known after the first evaluation.
  double scale() const { return scale_; }
  int NumParameters() const override { return 2 * static_cast<int>(start_.size()); }

  /// Returns seeds that stay valid until the next call.
  std::span<const Vec2> seeds(const double* parameters) const {
    std::vector<Vec2>& x = seeds_;
    const auto h = problem_.lengths();
    parallel_blocks(x.size(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        x[i] = start_[i] + h[i] * Vec2{parameters[2 * i], parameters[2 * i + 1]};
    });
    return x;
  }

 private:
  CvtProblem& problem_;
  std::vector<EnergySample>& samples_;
  std::vector<Vec2> start_;
  mutable double scale_ = 0;
  mutable std::vector<Vec2> seeds_;
};

/// Marks the evaluation of each accepted step.
class MarkAccepted final : public ceres::IterationCallback {
 public:
  MarkAccepted(std::vector<EnergySample>& samples, const ScaledEnergy& energy)
      : samples_(samples), energy_(energy) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary& summary) override {
    // The search may end at an earlier evaluation than its last one.
    for (auto sample = samples_.rbegin(); sample != samples_.rend() && !sample->accepted; ++sample)
      if (energy_.scale() * sample->energy == summary.cost) {
        sample->accepted = true;
        break;
      }
    return ceres::SOLVER_CONTINUE;
  }

 private:
  std::vector<EnergySample>& samples_;
  const ScaledEnergy& energy_;
};

}  // namespace

MinimiserOutcome minimise_cells(CvtProblem& problem, const MinimiserOptions& options,
                                std::vector<EnergySample>& samples) {
  std::vector<double> parameters(2 * static_cast<std::size_t>(problem.n_free()), 0.0);
  auto* energy = new ScaledEnergy(problem, samples);  // owned by the problem from here on
  const ceres::GradientProblem gradient_problem(energy);
  MarkAccepted mark(samples, *energy);
  ceres::GradientProblemSolver::Options solver;
  solver.line_search_direction_type = ceres::LBFGS;
  solver.line_search_type = ceres::WOLFE;
  solver.max_lbfgs_rank = 10;  // number of steps in the approximate Hessian
  solver.use_approximate_eigenvalue_bfgs_scaling = true;
  solver.max_num_iterations = options.iterations;
  solver.function_tolerance = options.function_tolerance;
  solver.gradient_tolerance = options.gradient_tolerance;
  solver.parameter_tolerance = 0;  // parameters are steps from the start, so there is no length to compare
  solver.logging_type = ceres::SILENT;
  solver.callbacks.push_back(&mark);
  ceres::GradientProblemSolver::Summary summary;
  const std::size_t first = samples.size();
  ceres::Solve(solver, gradient_problem, parameters.data(), &summary);
  check_cancelled();
  samples[first].accepted = true;  // not marked if the search converges at once

  problem.evaluate(energy->seeds(parameters.data()));
  MinimiserOutcome outcome;
  outcome.termination = summary.termination_type == ceres::CONVERGENCE ? MinimiserTermination::kConverged
                        : summary.termination_type == ceres::NO_CONVERGENCE
                            ? MinimiserTermination::kIterations
                            : MinimiserTermination::kStuck;
  outcome.iterations = static_cast<int>(summary.iterations.size()) - 1;
  outcome.gradient_norm = scaled_gradient_norm(problem);
  return outcome;
}

}  // namespace delquad
