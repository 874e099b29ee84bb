// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cad/weld_faces.h"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

namespace delquad::cad {

namespace {

using Triangle = std::array<int, 3>;
using Loop = std::vector<int>;

double area(const Vec3& a, const Vec3& b, const Vec3& c) { return norm(cross(b - a, c - a)) / 2; }

/// Returns the sides that lack a triangle, as chains: next[a] lists their ends from node a.
std::map<int, std::vector<int>> missing_sides(const std::vector<std::array<int, 2>>& boundary,
                                              const std::vector<Triangle>& triangles) {
  // Counts triangles that run from the lower to the higher end, minus opposite ones, minus the boundary's
  // sides.
  std::vector<std::pair<std::array<int, 2>, int>> counts;
  const auto count = [&](int a, int b, int n) {
    counts.push_back({{std::min(a, b), std::max(a, b)}, a < b ? n : -n});
  };
  for (const auto& [a, b] : boundary) count(a, b, -1);
  for (const auto& [a, b, c] : triangles) {
    count(a, b, 1);
    count(b, c, 1);
    count(c, a, 1);
  }
  std::ranges::sort(counts);
  std::map<int, std::vector<int>> next;
  for (auto it = counts.begin(); it != counts.end();) {
    const auto [a, b] = it->first;
    int excess = 0;
    for (const auto side = it->first; it != counts.end() && it->first == side; ++it) excess += it->second;
    for (; excess > 0; --excess) next[b].push_back(a);
    for (; excess < 0; ++excess) next[a].push_back(b);
  }
  return next;
}

/// Cuts the chains into loops that pass no node twice.
std::vector<Loop> simple_loops(std::map<int, std::vector<int>> next) {
  std::vector<Loop> loops;
  Loop path;
  while (!next.empty()) {
    if (path.empty()) path.push_back(next.begin()->first);
    const auto from = next.find(path.back());
    if (from == next.end()) break;  // impossible, since as many sides end at a node as begin there
    const int to = from->second.back();
    from->second.pop_back();
    if (from->second.empty()) next.erase(from);
    const auto passed = std::ranges::find(path, to);
    if (passed == path.end()) {
      path.push_back(to);
      continue;
    }
    loops.emplace_back(passed, path.end());
    path.erase(passed + 1, path.end());
    if (!next.contains(path.back())) path.clear();
  }
  return loops;
}

/// Returns the triangulation of a loop with the least area.
std::vector<Triangle> fill(const std::vector<Vec3>& points, const Loop& loop) {
  const int n = static_cast<int>(loop.size());
  std::vector<std::vector<std::pair<double, int>>> best(n, std::vector<std::pair<double, int>>(n, {0, -1}));
  for (int span = 2; span < n; ++span) {
    for (int i = 0; i + span < n; ++i) {
      const int k = i + span;
      best[i][k].first = std::numeric_limits<double>::infinity();
      for (int j = i + 1; j < k; ++j) {
        const double sum =
            best[i][j].first + best[j][k].first + area(points[loop[i]], points[loop[j]], points[loop[k]]);
        if (sum < best[i][k].first) best[i][k] = {sum, j};
      }
    }
  }
  std::vector<Triangle> triangles;
  std::vector<std::pair<int, int>> open{{0, n - 1}};
  while (!open.empty()) {
    const auto [i, k] = open.back();
    open.pop_back();
    const int j = best[i][k].second;
    if (j < 0) continue;
    triangles.push_back({loop[i], loop[j], loop[k]});
    open.push_back({i, j});
    open.push_back({j, k});
  }
  return triangles;
}

/// Removes pairs of triangles on the same nodes that run in opposite directions.
void remove_folded_pairs(std::vector<Triangle>& triangles) {
  const auto key = [&](int t) {
    Triangle v = triangles[t];
    std::ranges::sort(v);
    return v;
  };
  const auto is_even = [](const Triangle& v) { return (v[0] < v[1]) + (v[1] < v[2]) + (v[2] < v[0]) == 2; };
  std::vector<std::pair<Triangle, int>> order;
  for (int t = 0; t < static_cast<int>(triangles.size()); ++t) order.emplace_back(key(t), t);
  std::ranges::sort(order);
  std::vector<char> removed(triangles.size(), 0);
  for (std::size_t i = 0; i + 1 < order.size(); ++i) {
    const int s = order[i].second, t = order[i + 1].second;
    if (order[i].first != order[i + 1].first || is_even(triangles[s]) == is_even(triangles[t])) continue;
    removed[s] = removed[t] = 1;
    ++i;
  }
  std::size_t t = 0;
  std::erase_if(triangles, [&](const Triangle&) { return removed[t++] != 0; });
}

}  // namespace

double repair_face(const std::vector<Vec3>& points, const std::vector<std::array<int, 2>>& boundary,
                   std::vector<std::array<int, 3>>& triangles) {
  double worst = 0;
  for (const Loop& loop : simple_loops(missing_sides(boundary, triangles))) {
    double perimeter = 0, filled = 0;
    for (std::size_t i = 0; i < loop.size(); ++i)
      perimeter += norm(points[loop[(i + 1) % loop.size()]] - points[loop[i]]);
    // The filling's orientation is the orientation of the loop.
    for (const Triangle& t : fill(points, loop)) {
      filled += area(points[t[0]], points[t[1]], points[t[2]]);
      triangles.push_back(t);
    }
    if (filled > 0) worst = std::max(worst, filled / perimeter);
  }
  remove_folded_pairs(triangles);
  return worst;
}

bool is_manifold(const std::vector<std::array<int, 3>>& triangles) {
  std::vector<std::array<int, 2>> sides;
  for (const Triangle& t : triangles) {
    for (int k = 0; k < 3; ++k) {
      const int a = t[k], b = t[(k + 1) % 3];
      sides.push_back({std::min(a, b), std::max(a, b)});
    }
  }
  std::ranges::sort(sides);
  for (std::size_t i = 2; i < sides.size(); ++i)
    if (sides[i] == sides[i - 2]) return false;
  return true;
}

}  // namespace delquad::cad
