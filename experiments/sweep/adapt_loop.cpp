// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/sweep/adapt_loop.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/located.h"
#include "base/stopwatch.h"
#include "io/cases/expression.h"
#include "io/cases/read_described.h"

namespace delquad {
namespace {

constexpr const char* kGiven = "given";          // the case's own sizes
constexpr const char* kSquares = "squares";      // a loop
constexpr const char* kStretched = "stretched";  // a loop

bool is_loop(const AdaptLoop& loop) { return loop.kind == kSquares || loop.kind == kStretched; }

/// A seed would turn the domain away from its solution: it asks for a few more quads instead.
Case without_seed(const Case& c) {
  constexpr double kMost = 0.03, kGolden = 0.618;
  Case same = c;
  same.seed = 0;
  const double part = std::fmod(kGolden * static_cast<double>(c.seed), 1);
  if (same.quads) same.quads = std::llround(static_cast<double>(*c.quads) * (1 + kMost * part));
  return same;
}

}  // namespace

void read_study_keys(const TomlTable& table, Case& target) {
  read_fields(table, static_cast<CaseOfStudy&>(target));
  located(table.where("solution"), [&] { solution_of(target); });
}

void check_adapt(const Case& c) {
  if (!c.adapt && !c.solution.empty() && c.seed != 0)
    refuse("{}: 'seed' turns the domain but not the 'solution': leave 'seed' out, or give the key 'adapt'",
           c.where);
  if (!c.adapt) return;
  if (c.solution.empty()) refuse("{}: 'adapt' needs a 'solution', a formula in x and y", c.where);
  if (!c.quads) refuse("{}: 'adapt' needs 'quads', a number of quads", c.where);
  if (planar_model(c) == nullptr)
    refuse("{}: 'adapt' needs a planar model: expected 'loop', or a model file of curves", c.where);
  if (c.metric.asks()) refuse("{}: 'adapt' makes metrics of its own: expected no 'metric'", c.where);
}

Solution solution_of(const Case& c) {
  if (c.solution.empty()) return {};
  const Expression u(c.solution, {"x", "y"});
  return [u](const Vec3& at) -> ScalarSolution {
    const auto value = [&](double x, double y) {
      const double values[] = {x, y};
      return u(values);
    };
    // Central differences: the cube root of the rounding balances it and the third derivative.
    const double step = std::cbrt(std::numeric_limits<double>::epsilon()) / 8;
    return {value(at.x, at.y),
            {(value(at.x + step, at.y) - value(at.x - step, at.y)) / (2 * step),
             (value(at.x, at.y + step) - value(at.x, at.y - step)) / (2 * step), 0}};
  };
}

MeshResult mesh_in_loop(const Case& c, const std::function<MeshResult(const Case&)>& make) {
  if (!c.adapt) return make(c);
  Case next = without_seed(c);
  if (c.adapt->kind == kGiven) return make(next);
  next.size = {.text = "1"};  // of which 'quads' makes what it asks for
  MeshResult result = make(next);
  if (!is_loop(*c.adapt)) return result;
  next.size = {};
  AdaptSpec spec = c.adapt->spec;
  spec.quads = static_cast<double>(*next.quads);
  next.quads.reset();
  spec.isotropic = c.adapt->kind == kSquares;
  const auto exact = solution_of(c);
  for (int k = 1; k < c.adapt->meshes; ++k) {
    const Stopwatch watch;
    const std::vector<double> u = poisson_solution(result.mesh, exact, kGaussPointsInLayers);
    const std::vector<Recovery> recovered = {recover(result.mesh, u)};
    next.metric = {.limits = spec.limits, .gradation = spec.gradation, .complexity = spec.quads};
    next.metric.function = make_nodal_metric(result.mesh, adapted_metric(result.mesh, recovered, spec));
    const TimeSpent between = watch.time();
    MeshResult made = make(next);
    made.log.add_time("loop", between);
    for (const auto& [step, time] : result.log.times) made.log.add_time(step, time);
    made.seconds += result.seconds;
    result = std::move(made);
  }
  return result;
}

}  // namespace delquad
