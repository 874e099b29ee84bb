// SPDX-License-Identifier: GPL-3.0-or-later

#include <algorithm>
#include <cmath>

#include "algorithms/fields/tangent_metric.h"
#include "base/box.h"
#include "base/located.h"
#include "base/text.h"
#include "geometry/mesh/half_edges.h"
#include "mesher/adapt/adapt.h"
#include "mesher/adapt/elements.h"

namespace delquad {
namespace {

constexpr int kMostRounds = 60;
/// Tolerance of complexities and errors.
constexpr double kNear = 1e-3;
constexpr double kMostQuads = 1e9;
/// Limit of the scale of a metric whose lengths cannot become small enough.
constexpr double kMostScale = 1e60;

/// Returns the part of the area that belongs to each point.
std::vector<double> areas_at_points(const Mesh& mesh) {
  std::vector<double> area(mesh.points.size(), 0);
  for_each_element(mesh, [&](int, const auto& v) {
    const auto n = v.size();
    Vec3 sum;
    for (std::size_t k = 0; k < n; ++k) sum = sum + cross(mesh.points[v[k]], mesh.points[v[(k + 1) % n]]);
    for (const int i : v) area[i] += std::abs(sum.z) / 2 / static_cast<double>(n);
  });
  return area;
}

double complexity_of(const std::vector<Tensor2>& metric, const std::vector<double>& area) {
  double sum = 0;
  for (std::size_t i = 0; i < metric.size(); ++i) sum += area[i] * std::sqrt(determinant(metric[i]));
  return sum;
}

/// Returns the metric with all lengths scaled, within the limits, to this complexity.
std::vector<Tensor2> at_complexity(const std::vector<Tensor2>& metric, const std::vector<double>& area,
                                   const MetricLimits& limits, double complexity) {
  std::vector<Tensor2> made = metric;
  double scale = complexity / complexity_of(metric, area);
  for (int round = 0; round < kMostRounds; ++round) {
    for (std::size_t i = 0; i < metric.size(); ++i) made[i] = limited(times(scale, metric[i]), limits);
    const double factor = complexity / complexity_of(made, area);
    if (std::abs(factor - 1) < kNear) break;
    scale = std::min(kMostScale, scale * factor);
  }
  return made;
}

/// Returns the metric of one solution at the points of the given mesh.
std::vector<Tensor2> metric_of(const Mesh& mesh, const Recovery& solution, const AdaptSpec& spec) {
  std::vector<Tensor2> metric(mesh.points.size());
  std::vector<char> is_known(mesh.points.size(), 0);
  for (std::size_t i = 0; i < solution.origin.size(); ++i) {
    const int at = solution.origin[i];
    Tensor2 h = times(spec.weight.empty() ? 1 : spec.weight[at], solution.hessian[i]);
    if (spec.isotropic) {
      const double most = std::abs(h.xx + h.yy) / 2 + std::hypot((h.xx - h.yy) / 2, h.xy);
      h = {most, 0, most};
    }
    const Tensor2 m = lp_metric(h, spec.norm);
    metric[at] = is_known[at] ? intersection(metric[at], m) : m;
    is_known[at] = 1;
  }
  return metric;
}

/// Returns the error of a solution on quads that are unit squares along the axes of a metric.
double error_by(const Recovery& solution, const std::vector<Tensor2>& metric, double p) {
  const std::vector<double> area = areas_at_points(solution.mesh);
  constexpr double kBump = 0.125;  // maximum of x (1 - x) / 2
  constexpr int kSamples = 8;
  double sum = 0, most = 0;
  for (std::size_t i = 0; i < area.size(); ++i) {
    const MetricAxes axes = axes_of(metric[solution.origin[i]]);
    const Tensor2& h = solution.hessian[i];
    const double c = std::cos(axes.theta), s = std::sin(axes.theta);
    const double a = axes.h1 * axes.h1 * (c * c * h.xx + 2 * c * s * h.xy + s * s * h.yy);
    const double b = axes.h2 * axes.h2 * (s * s * h.xx - 2 * c * s * h.xy + c * c * h.yy);
    if (area[i] > 0)
      most = std::max({most, kBump * std::abs(a), kBump * std::abs(b), kBump * std::abs(a + b)});
    for (int j = 0; j < kSamples && std::isfinite(p); ++j)
      for (int k = 0; k < kSamples; ++k) {
        const double x = (j + 0.5) / kSamples, y = (k + 0.5) / kSamples;
        sum += area[i] / (kSamples * kSamples) * std::pow(std::abs(a * x * (1 - x) + b * y * (1 - y)) / 2, p);
      }
  }
  return std::isfinite(p) ? std::pow(sum, 1 / p) : most;
}

void check_spec(const Mesh& mesh, const AdaptSpec& spec) {
  if (!(spec.norm >= 1)) refuse("the norm {}: expected 1 to infinity", spec.norm);
  const auto is_good = [](double x) { return x > 0 && std::isfinite(x); };
  if (is_good(spec.quads) == is_good(spec.error) || spec.quads < 0 || spec.error < 0)
    refuse("{} quads and an error of {}: expected one of both above 0", spec.quads, spec.error);
  const auto& [min, max, aspect] = spec.limits;
  const auto is_none_or = [](double x, bool is_right) { return x == 0 || (is_right && std::isfinite(x)); };
  if (!is_none_or(min, min > 0) || !is_none_or(max, max > 0 && max >= min) ||
      !is_none_or(aspect, aspect >= 1) || !is_none_or(spec.gradation, spec.gradation > 1))
    refuse(
        "lengths from {} to {}, aspect {}, gradation {}: expected ascending lengths above 0, an aspect of at "
        "least 1 and a gradation above 1. A 0 stands for no limit",
        min, max, aspect, spec.gradation);
  if (spec.weight.empty()) return;
  require_values(mesh, spec.weight, "of weights");
  const auto least = std::ranges::min_element(spec.weight);
  if (*least < 0)
    refuse("the weight is {} at {}: expected at least 0", *least,
           show_point(mesh.points[least - spec.weight.begin()]));
  if (std::ranges::max(spec.weight) == 0) refuse("all weights are 0: expected at least one above 0");
}

}  // namespace

double complexity_of(const Mesh& mesh, const std::vector<Tensor2>& metric) {
  return complexity_of(metric, areas_at_points(mesh));
}

std::vector<Tensor2> adapted_metric(const Mesh& mesh, const std::vector<Recovery>& solutions,
                                    const AdaptSpec& spec) {
  check_spec(mesh, spec);
  if (solutions.empty()) refuse("there is no field to adapt to: expected at least one");
  const std::vector<double> area = areas_at_points(mesh);
  MetricLimits limits = spec.limits;
  if (!(limits.max > 0)) limits.max = diagonal(mesh);
  std::vector<std::vector<Tensor2>> each;
  for (const Recovery& solution : solutions) each.push_back(metric_of(mesh, solution, spec));
  const auto made = [&](double quads) {
    std::vector<Tensor2> all = at_complexity(each[0], area, limits, quads);
    for (std::size_t f = 1; f < each.size(); ++f) {
      const std::vector<Tensor2> other = at_complexity(each[f], area, limits, quads);
      for (std::size_t i = 0; i < all.size(); ++i) all[i] = intersection(all[i], other[i]);
    }
    return each.size() == 1 ? all : at_complexity(all, area, limits, quads);
  };
  if (spec.quads > 0) return made(spec.quads);
  // The error is about inversely proportional to the number.
  double quads = 1000;
  for (int round = 0; round < kMostRounds && quads < kMostQuads; ++round) {
    std::vector<Tensor2> metric = made(quads);
    double error = 0;
    for (const Recovery& solution : solutions) error = std::max(error, error_by(solution, metric, spec.norm));
    if (std::abs(error / spec.error - 1) < 10 * kNear) return metric;
    quads *= error / spec.error;
  }
  refuse(
      "an error of {:g} is not reached by up to {:g} quads within the limits of their lengths: expected a "
      "larger error or wider limits",
      spec.error, kMostQuads);
}

}  // namespace delquad
