#include "experiments/sweep/adapt_loop.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/located.h"
#include "base/stopwatch.h"
#include "experiments/sweep/schema.h"
#include "io/cases/case_file.h"
#include "io/cases/case_keys.h"
#include "io/cases/expression.h"

namespace delquad {
namespace {

using namespace toml_types;

constexpr const char* kGiven = "given";          // the case's own sizes
constexpr const char* kUniform = "uniform";      // the same size everywhere
constexpr const char* kSquares = "squares";      // a loop
constexpr const char* kStretched = "stretched";  // a loop
const std::vector<std::string> kKinds = {kGiven, kUniform, kSquares, kStretched};
constexpr int kMostMeshes = 100;

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

TomlKeys adapt_keys() {
  return {
      {"kind", "of the meshes: of the case's own sizes, of one size, or a loop", one_of(kKinds)},
      {"meshes", "of a loop, with the uniform one that it begins from", between("integer", 2, kMostMeshes)},
      {"norm", "p of the Lp norm of the error of interpolation", at_least("number", 1)},
      {"min", "least length", kPositive},
      {"max", "largest length", kPositive},
      {"aspect", "the most that one length is of the other", at_least("number", 1)},
      {"gradation", "the most that lengths grow by per unit length, a factor", at_least("number", 1)}};
}

void read_adapt_keys(const TomlTable& table, Case& target) {
  if (table.has("solution")) {
    target.solution = table.text("solution");
    located(table.where("solution"), [&] { solution_of(target); });
  }
  const auto adapt = table.optional_table("adapt");
  if (!adapt) return;
  adapt->require_known(adapt_keys());
  AdaptLoop loop = target.adapt.value_or(AdaptLoop());
  loop.kind = adapt->text("kind", loop.kind);
  if (std::ranges::find(kKinds, loop.kind) == kKinds.end())
    refuse("{}: kind '{}'{}", adapt->where("kind"), loop.kind, suggestion_or_all(loop.kind, kKinds));
  loop.meshes = read_count(*adapt, "meshes", 2, kMostMeshes, loop.meshes);
  loop.spec.norm = number_at_least(*adapt, "norm", 1, loop.spec.norm);
  const auto length = [&](const char* key, double absent) {
    return adapt->has(key) ? adapt->positive_number(key) : absent;
  };
  MetricLimits& limits = loop.spec.limits;
  limits = {length("min", limits.min), length("max", limits.max),
            number_at_least(*adapt, "aspect", 1, limits.aspect)};
  loop.spec.gradation = number_at_least(*adapt, "gradation", 1, loop.spec.gradation);
  adapt->finish(adapt_keys());
  target.adapt = loop;
}

void check_adapt(const Case& c) {
  if (!c.adapt && !c.solution.empty() && c.seed != 0)
    refuse("{}: a seed turns the domain, and not the 'solution': expected 'adapt', such as kind = \"given\"",
           c.where);
  if (!c.adapt) return;
  if (c.solution.empty()) refuse("{}: 'adapt' needs a 'solution', a formula in x and y", c.where);
  if (!c.quads) refuse("{}: 'adapt' needs 'quads', how many", c.where);
  if (planar_model(c) == nullptr) refuse("{}: 'adapt' needs a planar model", c.where);
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
