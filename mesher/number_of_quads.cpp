// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <cmath>

#include "base/calibration.h"
#include "base/stopwatch.h"
#include "delquad/error.h"
#include "features/scaling/scale_sizes.h"
#include "geometry/patches/meshing_setup.h"
#include "mesher/prepare.h"
#include "mesher/runner.h"

namespace delquad {
namespace {

/// Tolerance for the number of quads, and limit of meshes.
constexpr CalibrationLimits kLimits = {.tolerance = 0.03, .most_runs = 3};
/// Tolerance for the expected number before a mesh is made, and limit of guesses.
constexpr double kNearGuess = 0.01;
constexpr int kMostGuesses = 3;

bool has_size(const MeshProblem& problem) {
  const SizeSpec& size = problem.size;
  return problem.metric.asks() || size.field || size.function || size.from_boundary ||
         !size.sources.empty() || size.max > 0;
}

}  // namespace

MeshingSetup prepare_for_quads(MeshProblem& problem) {
  const long long wanted = *problem.quads;
  if (wanted < 1 || wanted > problem.max_elements)
    throw InputError(fmt::format("{}: {} quads: expected 1 to {} (max-elements)", problem.where, wanted,
                                 problem.max_elements));
  require_free_sizes(problem, fmt::format("{} quads", wanted));
  check_problem(problem);
  StepTimes before;
  if (!has_size(problem)) {
    const Stopwatch reading;
    const double area = model_info(problem).report.area;
    problem.size.field = make_constant_size(std::sqrt(area / static_cast<double>(wanted)));
    before.emplace_back("read", reading.time());
  }
  MeshingSetup made = prepare_problem(problem);
  for (int guess = 0; guess < kMostGuesses; ++guess) {
    const double share = made.size.expected_quads / static_cast<double>(wanted);
    if (std::abs(share - 1) <= kNearGuess) break;
    MeshProblem other = with_scaled_sizes(problem, std::sqrt(share));
    MeshingSetup next = prepare_problem(other, no_hints(made));
    // The number falls by less than half of the way if curves alone need more quads, however large the size.
    const bool follows = share < 1 || next.size.expected_quads < made.size.expected_quads / std::sqrt(share);
    const StepTimes& lost = follows ? made.times : next.times;
    before.insert(before.end(), lost.begin(), lost.end());
    if (!follows) break;
    problem = std::move(other);
    made = std::move(next);
  }
  made.times.insert(made.times.begin(), before.begin(), before.end());
  return made;
}

void match_quad_count(const Remesh& remesh, Prepared& prepared, MeshResult& result) {
  const MeshProblem first = prepared.problem();
  const long long asked = *first.quads;
  const auto wanted = static_cast<double>(asked);
  const auto worth = [&](const MeshResult& r) {
    return std::pair(!r.soundness.accepted(), std::abs(std::log(count_of_quads(r.mesh) / wanted)));
  };
  StageLog lost;  // the times of all meshes but the nearest
  double seconds = result.seconds;
  const auto quads_at = [&](double scale) -> std::optional<double> {
    if (scale == 1) return count_of_quads(result.mesh);
    try {
      auto [other, run] = remesh(with_scaled_sizes(first, scale));
      const double quads = count_of_quads(run.mesh);
      seconds += run.seconds;
      if (worth(run) < worth(result)) std::swap(prepared, other), std::swap(result, run);
      add_times(other->times, lost);
      add_times(run.log.times, lost);
      return quads;
    } catch (const InputError&) {
      return std::nullopt;  // no mesh can have that size
    }
  };
  const long long meshes = calibrate_scale(wanted, kLimits, quads_at).runs;
  add_times(lost.times, result.log);
  result.seconds = seconds;
  result.log.summaries.add("number_of_quads", {{"asked", asked}, {"meshes", meshes}});
  const double got = count_of_quads(result.mesh);
  if (std::abs(got / wanted - 1) > kLimits.tolerance)
    result.warnings.push_back(fmt::format(
        "{}: {} quads were asked for, and of {} meshes the nearest has {}. Fixed numbers of edges, layers, "
        "grids and small sizes at unsound places leave no nearer number [number-of-quads]",
        first.name, asked, meshes, got));
}

}  // namespace delquad
