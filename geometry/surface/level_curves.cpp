// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <set>

#include "geometry/surface/cut_path.h"

namespace delquad {

namespace {

/// Part of an edge within which crossings move into a vertex, to avoid slivers.
constexpr double kSnapInner = 0.15;
constexpr double kNearEnd = 0.3;
/// Part of an edge within which crossings near a boundary vertex touch the boundary.
constexpr double kTouch = 0.01;

class LevelWalk {
 public:
  LevelWalk(const Chart& chart, const std::vector<double>& u, double level)
      : chart_(chart), u_(u), level_(level), visited_(chart.triangles.size(), 0) {}

  std::vector<LevelCurve> run() {
    std::vector<LevelCurve> curves;
    auto add = [&](int t, int side) {
      const CutPath raw = walk(t, side);
      std::optional<CutPath> path = tidy(raw, kSnapInner);
      if (!path) path = tidy(raw, kTouch);
      if (!path) return;
      LevelCurve& curve = curves.emplace_back(LevelCurve{std::move(*path), {}});
      for (const EdgePoint& p : raw.points) curve.crossed.push_back({p.a, p.b});
      std::ranges::sort(curve.crossed);
    };
    const int n = static_cast<int>(chart_.triangles.size());
    for (int t = 0; t < n; ++t)
      for (int k = 0; k < 3; ++k)
        if (!visited_[t] && chart_.neighbours[t][k] < 0 && crosses(t, k)) add(t, k);
    for (int t = 0; t < n; ++t)
      for (int k = 0; k < 3; ++k)
        if (!visited_[t] && crosses(t, k)) add(t, k);
    return curves;
  }

 private:
  bool above(int v) const { return u_[v] >= level_; }
  int end(int t, int side, int which) const { return chart_.triangles[t][(side + 1 + which) % 3]; }
  bool crosses(int t, int side) const { return above(end(t, side, 0)) != above(end(t, side, 1)); }

  std::pair<int, int> ends(int t, int side) const { return std::minmax({end(t, side, 0), end(t, side, 1)}); }

  EdgePoint crossing(int t, int side) const {
    const auto [a, b] = ends(t, side);
    return {a, b, std::clamp((level_ - u_[a]) / (u_[b] - u_[a]), 0.0, 1.0)};
  }

  // Enters triangle t through a side and follows the curve until it leaves the chart or closes.
  CutPath walk(int t, int side) {
    CutPath path;
    path.closed = true;
    while (!visited_[t]) {
      visited_[t] = 1;
      path.points.push_back(crossing(t, side));
      const int out = crosses(t, (side + 1) % 3) ? (side + 1) % 3 : (side + 2) % 3;
      const int next = chart_.neighbours[t][out];
      if (next < 0) {
        path.points.push_back(crossing(t, out));
        path.closed = false;
        break;
      }
      const auto key = ends(t, out);
      for (int k = 0; k < 3; ++k)
        if (ends(next, k) == key) side = k;
      t = next;
    }
    return path;
  }

  bool on_boundary(int v) const { return v < chart_.n_boundary; }

  // Moves crossings into near vertices. Returns nothing if the path then touches itself or the boundary.
  std::optional<CutPath> tidy(const CutPath& path, double snap_inner) const {
    CutPath out;
    out.closed = path.closed;
    const std::size_t n = path.points.size();
    for (std::size_t i = 0; i < n; ++i) {
      EdgePoint p = path.points[i];
      const bool is_end = !path.closed && (i == 0 || i + 1 == n);
      const double snap = is_end ? kNearEnd : snap_inner;
      const int near = p.t < 0.5 ? p.a : p.b;
      if (std::min(p.t, 1 - p.t) < snap && (is_end || !on_boundary(near))) p = {near, -1, 0};
      if (!is_end && p.b >= 0 && std::min(p.t, 1 - p.t) < kTouch) return std::nullopt;
      if (out.points.empty() || !(out.points.back() == p)) out.points.push_back(p);
    }
    if (out.closed && out.points.size() > 1 && out.points.front() == out.points.back()) out.points.pop_back();
    if (out.points.size() < (out.closed ? 3 : 2)) return std::nullopt;
    return measured(chart_, std::move(out));
  }

  const Chart& chart_;
  const std::vector<double>& u_;
  double level_;
  std::vector<char> visited_;
};

}  // namespace

Vec3 position(const Chart& chart, const EdgePoint& p) {
  if (p.b < 0) return chart.points[p.a];
  return (1 - p.t) * chart.points[p.a] + p.t * chart.points[p.b];
}

namespace {

/// Returns whether the path is only a side of the boundary.
bool is_boundary_side(const Chart& chart, const CutPath& path) {
  if (path.points.size() != 2 || path.points[0].b >= 0 || path.points[1].b >= 0) return false;
  const auto ends = std::minmax({path.points[0].a, path.points[1].a});
  for (const auto& loop : chart.loops)
    for (std::size_t k = 0; k < loop.size(); ++k)
      if (std::minmax({loop[k], loop[(k + 1) % loop.size()]}) == ends) return true;
  return false;
}

}  // namespace

std::optional<CutPath> measured(const Chart& chart, CutPath path) {
  if (is_boundary_side(chart, path)) return std::nullopt;
  std::set<std::pair<int, int>> seen;
  for (const EdgePoint& p : path.points)
    if (!seen.insert(std::minmax({p.a, p.b})).second) return std::nullopt;
  const std::size_t n = path.points.size();
  for (std::size_t i = 0; i + (path.closed ? 0 : 1) < n; ++i)
    path.length += norm(position(chart, path.points[(i + 1) % n]) - position(chart, path.points[i]));
  return path;
}

std::vector<LevelCurve> level_curves(const Chart& chart, const std::vector<double>& u, double level) {
  return LevelWalk(chart, u, level).run();
}

}  // namespace delquad
