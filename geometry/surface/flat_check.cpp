// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/surface/flatten.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

#include "base/predicates.h"
#include "geometry/planar/arrangement.h"

namespace delquad {

namespace {

/// Returns the value at a fraction of the weight; pairs are (value, weight), sorted.
double percentile(const std::vector<std::pair<double, double>>& sorted, double fraction) {
  double total = 0, sum = 0;
  for (const auto& [value, weight] : sorted) total += weight;
  for (const auto& [value, weight] : sorted)
    if ((sum += weight) >= fraction * total) return value;
  return sorted.back().first;
}

double signed_area(const std::vector<Vec2>& points, const std::vector<int>& loop) {
  double sum = 0;
  for (std::size_t k = 0; k < loop.size(); ++k)
    sum += cross(points[loop[k]] - points[loop[0]], points[loop[(k + 1) % loop.size()]] - points[loop[0]]);
  return sum / 2;
}

}  // namespace

bool is_one_to_one(const Chart& chart, const std::vector<Vec2>& flat) {
  assert(flat.size() == chart.points.size());
  for (const Vec2& p : flat)
    if (!std::isfinite(p.x) || !std::isfinite(p.y)) return false;
  for (const auto& [a, b, c] : chart.triangles)
    if (orient2d(flat[a], flat[b], flat[c]) <= 0) return false;
  // Triangles cover each point as often as the loops wind around it. This is once if loops are disjoint
  // simple curves and only one is counterclockwise.
  std::vector<std::pair<double, double>> boundary;
  for (int v = 0; v < chart.n_boundary; ++v) boundary.push_back({flat[v].x, flat[v].y});
  std::ranges::sort(boundary);
  if (std::ranges::adjacent_find(boundary) != boundary.end()) return false;
  const auto outer =
      std::ranges::count_if(chart.loops, [&](const auto& loop) { return signed_area(flat, loop) > 0; });
  std::vector<std::array<int, 2>> lines;
  for (const auto& loop : chart.loops)
    for (std::size_t k = 0; k < loop.size(); ++k) lines.push_back({loop[k], loop[(k + 1) % loop.size()]});
  return outer == 1 && !arrange(flat, lines).conflict;
}

FlatQuality measure_flat(const Chart& chart, const std::vector<Vec2>& flat) {
  assert(is_one_to_one(chart, flat));
  const std::vector<double> areas = triangle_areas(chart);
  const double total = std::accumulate(areas.begin(), areas.end(), 0.0);
  // Triangles without area have no distortion.
  const double least = 1e-9 * total / static_cast<double>(areas.size());
  std::vector<std::pair<double, double>> sigma, scale;
  FlatQuality quality;
  double sum = 0, weight = 0;
  for (std::size_t t = 0; t < areas.size(); ++t) {
    if (areas[t] <= least) continue;
    const auto& [a, b, c] = chart.triangles[t];
    const auto at = corners_of(chart, static_cast<int>(t));
    const Vec3 e1 = at[1] - at[0], e2 = at[2] - at[0];
    // The triangle in its plane: (l, 0) and (x, y).
    const double l = norm(e1), x = dot(e1, e2) / l, y = 2 * areas[t] / l;
    const Vec2 f1 = flat[b] - flat[a], f2 = flat[c] - flat[a];
    const Vec2 du = (1 / l) * f1, dv = (1 / y) * (f2 - x * du);
    const double det = cross(du, dv), half_trace = (dot(du, du) + dot(dv, dv)) / 2;
    const double large = half_trace + std::sqrt(std::max(0.0, half_trace * half_trace - det * det));
    const double ratio =
        large / det;  // largest over smallest singular value: largest squared over the determinant
    sigma.push_back({ratio, areas[t]});
    scale.push_back({det, areas[t]});
    sum += ratio * areas[t];
    weight += areas[t];
  }
  if (sigma.empty()) return quality;
  std::ranges::sort(sigma);
  std::ranges::sort(scale);
  quality.sigma_mean = sum / weight;
  quality.sigma_95 = percentile(sigma, 0.95);
  quality.sigma_max = sigma.back().first;
  quality.area_ratio = percentile(scale, 0.99) / percentile(scale, 0.01);
  quality.extreme_ratio = percentile(scale, 0.999) / percentile(scale, 0.001);
  return quality;
}

}  // namespace delquad
