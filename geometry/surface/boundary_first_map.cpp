// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <numeric>

#include "geometry/surface/chart.h"
#include "geometry/surface/conformal_maps.h"
#include "geometry/surface/laplacian.h"

namespace delquad {

namespace {

/// Returns the closed polygon with the given turns at its vertices and sides as near as possible to
/// `lengths`.
std::vector<Vec2> close_polygon(const std::vector<double>& turns, const std::vector<double>& lengths) {
  const std::size_t n = turns.size();
  std::vector<Vec2> direction(n);
  double phi = 0, a = 0, b = 0, d = 0;
  Vec2 gap;
  for (std::size_t i = 0; i < n; ++i) {
    if (i > 0) phi += turns[i];
    const Vec2 t = direction[i] = {std::cos(phi), std::sin(phi)};
    gap += lengths[i] * t;
    // sum of length t t^T: sides change in proportion to their lengths
    a += lengths[i] * t.x * t.x;
    b += lengths[i] * t.x * t.y;
    d += lengths[i] * t.y * t.y;
  }
  const double det = a * d - b * b;
  const Vec2 w = {(d * gap.x - b * gap.y) / det, (a * gap.y - b * gap.x) / det};
  std::vector<Vec2> polygon;
  Vec2 at;
  for (std::size_t i = 0; i < n; ++i) {
    polygon.push_back(at);
    at += lengths[i] * (1 - dot(w, direction[i])) * direction[i];
  }
  return polygon;
}

/// Reduces turns at tips of slits and cusps, where both sides would touch or cross, and increases the turns
/// beside.
void keep_open(std::vector<double>& turns) {
  constexpr double kOpen = 2 * std::numbers::pi / 180;
  const std::size_t n = turns.size();
  for (std::size_t i = 0; i < n; ++i) {
    const double excess = kOpen - std::numbers::pi - turns[i];
    if (excess <= 0) continue;
    turns[i] += excess;
    turns[(i + 1) % n] -= excess / 2;
    turns[(i + n - 1) % n] -= excess / 2;
  }
}

/// Returns the disk inside of the closed polygon with these turns and sides, by harmonic coordinates.
std::vector<Vec2> fill_polygon(const LaplaceSolver& solver, const std::vector<double>& turns,
                               const std::vector<double>& lengths, std::size_t n) {
  const std::vector<Vec2> polygon = close_polygon(turns, lengths);
  std::vector<double> x(n, 0.0), y(n, 0.0);
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    x[i] = polygon[i].x;
    y[i] = polygon[i].y;
  }
  const std::vector<double> none(n, 0.0);
  x = solver.solve(x, none);
  y = solver.solve(y, none);
  std::vector<Vec2> flat(n);
  for (std::size_t v = 0; v < n; ++v) flat[v] = {x[v], y[v]};
  return flat;
}

/// Returns the solver of a chart with a fixed boundary.
LaplaceSolver solver_inside(const Chart& chart) {
  std::vector<char> fixed(chart.points.size(), 0);
  std::fill_n(fixed.begin(), chart.n_boundary, 1);
  return {chart, fixed};
}

/// Least turn, radians, of a corner of the boundary.
constexpr double kCorner = std::numbers::pi / 6;

}  // namespace

std::vector<Vec2> boundary_first_map(const Chart& chart) {
  assert(chart.loops.size() == 1 && genus(chart) == 0);
  const std::size_t n = chart.points.size(), n_boundary = static_cast<std::size_t>(chart.n_boundary);
  const LaplaceSolver solver = solver_inside(chart);
  const std::vector<double> defects = angle_defects(chart);
  std::vector<double> load(n, 0.0);
  for (std::size_t v = n_boundary; v < n; ++v) load[v] = -defects[v];
  const std::vector<double> log_scale = solver.solve(std::vector<double>(n, 0.0), load);
  const std::vector<double> flux = solver.apply(log_scale);

  std::vector<double> turns;
  for (std::size_t i = 0; i < n_boundary; ++i) turns.push_back(defects[i] + flux[i]);
  keep_open(turns);
  return fill_polygon(solver, turns, boundary_lengths(chart), n);
}

std::vector<Vec2> convex_map(const Chart& chart) {
  assert(chart.loops.size() == 1 && genus(chart) == 0);
  const std::size_t n = chart.points.size(), n_boundary = static_cast<std::size_t>(chart.n_boundary);
  const std::vector<double> defects = angle_defects(chart);
  std::vector<double> lengths = boundary_lengths(chart), turns(n_boundary, 0.0);
  for (std::size_t i = 0; i < n_boundary; ++i)
    if (defects[i] > kCorner) turns[i] = defects[i];
  const double full = 2 * std::numbers::pi, corners = std::accumulate(turns.begin(), turns.end(), 0.0);
  const double length = std::accumulate(lengths.begin(), lengths.end(), 0.0);
  const double part = corners > full ? full / corners : 1;
  for (std::size_t i = 0; i < n_boundary; ++i)
    turns[i] = part * turns[i] + (full - part * corners) *
                                     (lengths[i] + lengths[(i + n_boundary - 1) % n_boundary]) / (2 * length);
  // The scale with these turns is unique up to a factor, which a shift far below the first eigenvalue
  // chooses.
  const std::vector<double> areas = triangle_areas(chart);
  const LaplaceSolver free(chart, std::vector<char>(n, 0),
                           1e-6 / std::accumulate(areas.begin(), areas.end(), 0.0));
  std::vector<double> load(n, 0.0);
  for (std::size_t v = 0; v < n; ++v) load[v] = (v < n_boundary ? turns[v] : 0) - defects[v];
  const std::vector<double> log_scale = free.solve(std::vector<double>(n, 0.0), load);
  for (std::size_t i = 0; i < n_boundary; ++i)
    lengths[i] *= std::exp((log_scale[i] + log_scale[(i + 1) % n_boundary]) / 2 - log_scale[0]);
  return fill_polygon(solver_inside(chart), turns, lengths, n);
}

}  // namespace delquad
