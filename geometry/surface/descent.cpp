// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "geometry/surface/cut_path.h"

namespace delquad {

namespace {

/// Part of an edge within which crossings move into a vertex, to avoid slivers.
constexpr double kSnap = 0.12;
constexpr double kSnapEnd = 0.3;

class Descent {
 public:
  Descent(const Chart& chart, const std::vector<std::vector<int>>& around, const std::vector<double>& u,
          const std::vector<char>& target)
      : chart_(chart), around_(around), u_(u), target_(target) {}

  std::optional<CutPath> run(int start) {
    go_to_vertex(start);
    // u falls with each step, except for rounding; a path with more steps than triangles meets itself.
    for (std::size_t steps = 0; !arrived_; ++steps)
      if (steps > chart_.triangles.size() || !(at_.b < 0 ? leave_vertex() : leave_edge()))
        return std::nullopt;
    return measured(chart_, std::move(path_));
  }

 private:
  bool on_boundary(int v) const { return v < chart_.n_boundary; }
  double value(const EdgePoint& p) const { return p.b < 0 ? u_[p.a] : (1 - p.t) * u_[p.a] + p.t * u_[p.b]; }

  void go_to_vertex(int v) {
    at_ = {v, -1, 0};
    arrived_ = !path_.points.empty() && (target_[v] || on_boundary(v));
    path_.points.push_back(at_);
  }

  // Leaves triangle t by the side opposite to vertex k, at (1 - s) times its first end plus s times the
  // second.
  void cross_side(int t, int k, double s) {
    const int a = chart_.triangles[t][(k + 1) % 3], b = chart_.triangles[t][(k + 2) % 3];
    const int near = s < 0.5 ? a : b;
    const double distance = std::min(s, 1 - s);
    const bool leaves = chart_.neighbours[t][k] < 0;
    if (leaves || target_[near]) {
      if (distance < kSnapEnd) return go_to_vertex(near);
    } else if (distance < kSnap && !on_boundary(near) && u_[near] < value(at_)) {
      return go_to_vertex(near);
    }
    s = std::clamp(s, 1e-6, 1 - 1e-6);
    at_ = {a, b, s};
    triangle_ = chart_.neighbours[t][k];
    arrived_ = leaves;
    path_.points.push_back(at_);
  }

  // Computes the rates of the barycentric coordinates along the steepest descent of u. Returns its slope.
  double rates(int t, double (&rate)[3]) const {
    const auto& v = chart_.triangles[t];
    Vec3 side[3];
    for (int k = 0; k < 3; ++k) side[k] = chart_.points[v[(k + 2) % 3]] - chart_.points[v[(k + 1) % 3]];
    const double square = dot(cross(side[0], side[1]), cross(side[0], side[1]));  // (2 area)^2
    if (square == 0) return 0;
    // grad lambda_i . grad lambda_j = side_i . side_j / (2 area)^2
    double slope = 0;
    for (int i = 0; i < 3; ++i) {
      rate[i] = 0;
      for (int j = 0; j < 3; ++j) rate[i] -= u_[v[j]] * dot(side[i], side[j]) / square;
    }
    for (int i = 0; i < 3; ++i) slope -= rate[i] * u_[v[i]];
    return std::sqrt(std::max(0.0, slope));
  }

  bool leave_vertex() {
    const int v = at_.a;
    double steepest = 0;
    int triangle = -1, side = -1, neighbour = -1;
    double where = 0;
    for (int t : around_[v]) {
      const auto& corners = chart_.triangles[t];
      const int k = static_cast<int>(std::ranges::find(corners, v) - corners.begin());
      const int q = (k + 1) % 3, r = (k + 2) % 3;
      double rate[3];
      const double slope = rates(t, rate);
      if (slope > steepest && rate[q] > 0 && rate[r] > 0) {
        steepest = slope;
        triangle = t;
        side = k;
        where = rate[r] / (rate[q] + rate[r]);
      }
      for (const auto& [w, opposite] : {std::pair(corners[q], r), std::pair(corners[r], q)}) {
        if (chart_.neighbours[t][opposite] < 0) continue;  // the side lies on the boundary
        const double length = norm(chart_.points[w] - chart_.points[v]);
        const double edge_slope = length > 0 ? (u_[v] - u_[w]) / length : 0;
        if (edge_slope > steepest) {
          steepest = edge_slope;
          triangle = -1;
          neighbour = w;
        }
      }
    }
    if (steepest <= 0) return false;
    if (triangle >= 0)
      cross_side(triangle, side, where);
    else
      go_to_vertex(neighbour);
    return true;
  }

  bool leave_edge() {
    const int t = triangle_;
    const auto& v = chart_.triangles[t];
    int k = 0;
    while (v[k] == at_.a || v[k] == at_.b) ++k;
    const int a = (k + 1) % 3, b = (k + 2) % 3;
    double lambda[3], rate[3];
    lambda[k] = 0;
    lambda[a] = v[a] == at_.a ? 1 - at_.t : at_.t;
    lambda[b] = 1 - lambda[a];
    const double slope = rates(t, rate);
    if (slope <= 0 || rate[k] <= 0) {  // both triangles lead to the edge: follow it downwards
      if (u_[v[a]] == u_[v[b]]) return false;
      go_to_vertex(u_[v[a]] < u_[v[b]] ? v[a] : v[b]);
      return true;
    }
    const double far = std::numeric_limits<double>::infinity();
    const double time_a = rate[a] < 0 ? lambda[a] / -rate[a] : far;
    const double time_b = rate[b] < 0 ? lambda[b] / -rate[b] : far;
    if (time_a < time_b)  // leaves by the side opposite to a, from b to k
      cross_side(t, a, time_a * rate[k] / (time_a * rate[k] + lambda[b] + time_a * rate[b]));
    else  // opposite to b: from k to a
      cross_side(t, b, (lambda[a] + time_b * rate[a]) / (time_b * rate[k] + lambda[a] + time_b * rate[a]));
    return true;
  }

  const Chart& chart_;
  const std::vector<std::vector<int>>& around_;
  const std::vector<double>& u_;
  const std::vector<char>& target_;
  CutPath path_;
  EdgePoint at_;
  int triangle_ = -1;  ///< next triangle of the path, if it is on an edge
  bool arrived_ = false;
};

}  // namespace

std::optional<CutPath> descend(const Chart& chart, const std::vector<std::vector<int>>& around,
                               const std::vector<double>& u, int start, const std::vector<char>& target) {
  return Descent(chart, around, u, target).run(start);
}

}  // namespace delquad
