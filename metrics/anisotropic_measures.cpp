// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrics/anisotropic_measures.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "base/parallel.h"

namespace delquad {
namespace {

/// Lengths of edges in range are at most this, and at least its inverse.
constexpr double kRange = std::numbers::sqrt2;
/// Largest angle, in the metric, between an edge and the axis that it follows.
constexpr double kAlong = 8 * std::numbers::pi / 180;

constexpr std::array kEqualWeights{0.25, 0.25, 0.25, 0.25};

std::vector<double> etas_by(const Mesh& mesh, const MetricAt& metric_at) {
  std::vector<double> etas(mesh.quads.size());
  parallel_ranges(etas.size(), [&](std::size_t begin, std::size_t end) {
    int hint = -1;
    for (std::size_t q = begin; q < end; ++q) {
      std::array<TangentMetric, 4> at;
      for (int k = 0; k < 4; ++k) at[k] = metric_at(mesh.quad_region[q], mesh.points[mesh.quads[q][k]], hint);
      const TangentMetric mean = log_mean(at, kEqualWeights);
      const MetricAxes axes = axes_of(mean.m);
      const Vec2 e{std::cos(axes.theta), std::sin(axes.theta)};
      std::array<Vec2, 4> x;
      for (int k = 0; k < 4; ++k) {
        const Vec2 p = mean.in_plane(mesh.points[mesh.quads[q][k]]);
        x[k] = {dot(p, e) / axes.h1, cross(e, p) / axes.h2};
      }
      etas[q] = quad_eta(x[0], x[1], x[2], x[3]);
    }
  });
  return etas;
}

/// Returns the angle between d and the nearest axis, in the metric.
double angle_from_axes(const Vec3& way, const TangentMetric& metric) {
  const MetricAxes axes = axes_of(metric.m);
  const Vec2 e{std::cos(axes.theta), std::sin(axes.theta)}, d = metric.in_plane(way);
  const double u = std::abs(dot(d, e)) / axes.h1, v = std::abs(cross(e, d)) / axes.h2;
  return std::atan2(std::min(u, v), std::max(u, v));
}

}  // namespace

const std::vector<Metric>& anisotropic_measures() {
  using enum Better;
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  static const std::vector<Metric> all = {
      {"metric_eta_mean", "eta_M mean", "", kHigher, 0, "eta in the metric, mean over quads"},
      {"metric_eta_worst", "eta_M worst", "", kHigher, 0, "eta in the metric, least over quads"},
      {"metric_tau", "tau_M", "%", kHigher, 0, "tau by lengths in the metric"},
      {"metric_in_range", "in range", "%", kHigher, 0,
       "edges whose lengths in the metric are from 1 / sqrt 2 to sqrt 2 [ugawg2017]", 1},
      {"metric_edge_min", "edge_M min", "", kHigher, 0, "shortest edge, in the metric"},
      {"metric_edge_max", "edge_M max", "", kLower, kInfinite, "longest edge, in the metric"},
      {"metric_aligned", "aligned", "%", kNeither, 0,
       "inner edges within 8 degrees of an axis of the metric, in the metric", 1},
  };
  return all;
}

std::vector<double> anisotropic_etas(const Mesh& mesh, const MetricAt& metric) {
  return etas_by(mesh, metric);
}

std::map<std::string, double> measure_anisotropic(const Mesh& mesh, std::span<const HalfEdge> sides,
                                                  const MetricAt& metric_at) {
  std::map<std::string, double> values;
  for (const Metric& m : anisotropic_measures()) values[m.key] = std::numeric_limits<double>::quiet_NaN();
  if (sides.empty()) return values;
  const std::vector<double> etas = etas_by(mesh, metric_at);
  int hint = -1;
  double edges = 0, sum = 0, in_range = 0, inner = 0, aligned = 0;
  double shortest = std::numeric_limits<double>::infinity(), longest = 0;
  for_each_edge(sides, [&](std::span<const HalfEdge> edge) {
    const Vec3 a = mesh.points[edge[0].lo], b = mesh.points[edge[0].hi];
    const int region = region_of(mesh, edge[0].element);
    const TangentMetric at_a = metric_at(region, a, hint), at_b = metric_at(region, b, hint);
    const double length = metric_length(b - a, at_a, at_b);
    ++edges;
    sum += length < 1 ? length - 1 : 1 / length - 1;
    in_range += length <= kRange && length * kRange >= 1 ? 1 : 0;
    shortest = std::min(shortest, length), longest = std::max(longest, length);
    if (edge.size() != 2) return;
    ++inner;
    const TangentMetric mean = log_mean(std::array{at_a, at_b}, std::array{0.5, 0.5});
    aligned += angle_from_axes(b - a, mean) <= kAlong ? 1 : 0;
  });
  if (!etas.empty()) {
    values["metric_eta_mean"] =
        std::accumulate(etas.begin(), etas.end(), 0.0) / static_cast<double>(etas.size());
    values["metric_eta_worst"] = *std::ranges::min_element(etas);
  }
  values["metric_tau"] = 100 * std::exp(sum / edges);
  values["metric_in_range"] = 100 * in_range / edges;
  values["metric_edge_min"] = shortest;
  values["metric_edge_max"] = longest;
  if (inner > 0) values["metric_aligned"] = 100 * aligned / inner;
  return values;
}

}  // namespace delquad
