// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/cvt/smooth_points.h"

#include <cmath>

#include "base/located.h"
#include "base/option_table.h"
#include "base/stopwatch.h"
#include "smoothing/cvt/moving_delaunay.h"

namespace delquad {
namespace {

SmoothingTermination of_minimiser(MinimiserTermination termination) {
  switch (termination) {
    case MinimiserTermination::kConverged:
      return SmoothingTermination::kConverged;
    case MinimiserTermination::kIterations:
      return SmoothingTermination::kIterations;
    case MinimiserTermination::kStuck:
      return SmoothingTermination::kStuck;
  }
  return SmoothingTermination::kStuck;
}

/// Takes new frames and minimizes, up to outer_iterations times.
void smooth(CvtProblem& problem, const CrossField& cross, const ParametricSize& size,
            const SmoothingOptions& options, SmoothingSummary& s) {
  problem.hold_frames(cross, size);
  const std::optional<double> first = problem.evaluate(problem.seeds());
  s.evaluations = 1;
  if (!first) {
    s.refused = 1;
    s.termination = SmoothingTermination::kRefused;
    return;
  }
  s.first_energy = s.final_energy = *first;
  s.gradient_norm = scaled_gradient_norm(problem);
  if (problem.n_free() == 0) return;
  if (options.outer_iterations == 0 || options.inner.iterations == 0)
    s.termination = SmoothingTermination::kIterations;
  if (options.inner.iterations == 0) return;

  for (int outer = 0; outer < options.outer_iterations; ++outer) {
    if (outer > 0) problem.hold_frames(cross, size);
    const std::size_t n_samples = s.samples.size();
    const MinimiserOutcome outcome = minimise_cells(problem, options.inner, s.samples);
    double last = 0;
    for (std::size_t i = n_samples; i < s.samples.size(); ++i) {
      s.samples[i].frames = outer;
      if (s.samples[i].accepted) last = s.samples[i].energy;
    }
    s.termination = of_minimiser(outcome.termination);
    s.outer_iterations = outer + 1;
    s.iterations += outcome.iterations;
    s.gradient_norm = outcome.gradient_norm;
    s.final_energy = last;
    if (outcome.iterations == 0) break;  // the frames were current
  }
  if (!s.samples.empty()) s.evaluations = static_cast<int>(s.samples.size());
  for (const EnergySample& sample : s.samples) s.refused += std::isnan(sample.energy) ? 1 : 0;
}

void check_at_least(const char* name, double value, double least) {
  if (!(value >= least)) refuse("{} is {}: expected at least {}", name, value, least);
}

}  // namespace

const char* name_of(SmoothingTermination termination) {
  switch (termination) {
    case SmoothingTermination::kConverged:
      return "converged";
    case SmoothingTermination::kIterations:
      return "iterations";
    case SmoothingTermination::kStuck:
      return "stuck";
    case SmoothingTermination::kRefused:
      return "refused";
  }
  return "";
}

void append_counter(std::vector<SummaryField>& fields, const char* key, SmoothingTermination value, Over,
                    double) {
  fields.push_back({key, std::map<std::string, long long>{{name_of(value), 1}}});
}

void append_counter(std::vector<SummaryField>& fields, const char* key,
                    const std::vector<EnergySample>& samples, Over, double) {
  std::vector<double> energies, firsts, accepted;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    energies.push_back(samples[i].energy);
    if (i == 0 || samples[i].frames != samples[i - 1].frames) firsts.push_back(static_cast<double>(i));
    if (samples[i].accepted) accepted.push_back(static_cast<double>(i));
  }
  using Lists = std::vector<std::vector<double>>;
  fields.push_back({key, Lists{std::move(energies)}});
  fields.push_back({"first_of_frames", Lists{std::move(firsts)}});
  fields.push_back({"accepted_evaluations", Lists{std::move(accepted)}});
}

void check_options(const SmoothingOptions& options) {
  check_norm(options.p);
  check_at_least("outer_iterations", options.outer_iterations, 0);
  check_at_least("inner_iterations", options.inner.iterations, 0);
  check_at_least("function_tolerance", options.inner.function_tolerance, 0);
  check_at_least("gradient_tolerance", options.inner.gradient_tolerance, 0);
}

TriPatch smooth_points(const TriPatch& patch, const CrossField& cross, const ParametricSize& size,
                       const SmoothingOptions& options, SmoothingSummary* summary) {
  const Stopwatch watch;
  check_options(options);
  const std::vector<int> order = spatial_order(patch);
  CvtProblem problem(MovingDelaunay(reordered(patch, order)), options.p);
  SmoothingSummary s;
  s.cells = problem.delaunay().n_points();
  smooth(problem, cross, size, options, s);
  s.flips = problem.delaunay().flips();
  s.rebuilds = problem.delaunay().rebuilds();
  s.seconds = watch.seconds();
  if (summary != nullptr) *summary = std::move(s);
  std::vector<int> back(order.size());
  for (std::size_t k = 0; k < order.size(); ++k)
    back[order[k] - patch.n_boundary] = patch.n_boundary + static_cast<int>(k);
  return reordered(problem.delaunay().patch(), back);
}

namespace {

constexpr double kMostRounds = 1e6;

const OptionTable<SmoothingOptions>& table() {
  static const auto all =
      OptionTable<SmoothingOptions>("smoothing", "options of L")
          .add({.name = "p", .help = "norm", .allowed = {2, 4, 6, 8, 10, 12, 14, 16}}, &SmoothingOptions::p)
          .add({.name = "outer_iterations",
                .help = "number of updates of size and directions",
                .least = 0,
                .most = kMostRounds},
               &SmoothingOptions::outer_iterations)
          .add(
              {.name = "inner_iterations", .help = "steps for each", .least = 0, .most = kMostRounds},
              [](auto& o) -> auto& { return o.inner.iterations; })
          .add(
              {.name = "function_tolerance", .help = "relative", .least = 0},
              [](auto& o) -> auto& { return o.inner.function_tolerance; });
  return all;
}

}  // namespace

OptionGroup smoothing_group() { return table().group(); }
SmoothingOptions smoothing_options(const Options& options) { return table().read(options); }

}  // namespace delquad
