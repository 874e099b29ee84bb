// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include "base/predicates.h"
#include "delquad/mesh.h"
#include "tests/support/shapes.h"

/// Triangulations made in code.
namespace delquad::testing_support {

/// Neighbors found from the triangles' sides.
inline TriPatch make_patch(std::vector<Vec2> points, std::vector<std::array<int, 3>> triangles,
                           int n_boundary) {
  TriPatch tri;
  tri.points = std::move(points);
  tri.triangles = std::move(triangles);
  tri.n_boundary = n_boundary;
  std::map<std::pair<int, int>, int> owner;
  for (std::size_t t = 0; t < tri.triangles.size(); ++t) {
    const auto& v = tri.triangles[t];
    for (int k = 0; k < 3; ++k) owner[{v[(k + 1) % 3], v[(k + 2) % 3]}] = static_cast<int>(t);
  }
  for (const auto& v : tri.triangles) {
    auto& n = tri.neighbours.emplace_back();
    for (int k = 0; k < 3; ++k) {
      const auto it = owner.find({v[(k + 2) % 3], v[(k + 1) % 3]});
      n[k] = it == owner.end() ? -1 : it->second;
    }
  }
  return tri;
}

/// Calls f with every triangulation of the regular n-gon without inner points (a Catalan number of them).
inline void for_each_polygon_triangulation(int n, const std::function<void(const TriPatch&)>& f) {
  const std::vector<Vec2> points = shapes::disk(1, n).points;
  std::vector<std::array<int, 3>> triangles;
  std::vector<std::pair<int, int>> open = {
      {0, n - 1}};  // sides i-j whose far part is still to be triangulated
  std::function<void()> next = [&] {
    while (!open.empty() && open.back().second - open.back().first < 2) open.pop_back();
    if (open.empty()) return f(make_patch(points, triangles, n));
    const auto saved = open;
    const auto [i, j] = open.back();
    for (int k = i + 1; k < j; ++k) {
      open.pop_back();
      open.emplace_back(i, k);
      open.emplace_back(k, j);
      triangles.push_back({i, k, j});
      next();
      triangles.pop_back();
      open = saved;
    }
  };
  next();
}

/// Up to n random points in the patch that keep `distance` from its boundary points and from each other and
/// half of it from its edges. The patch lies inside [-1, 1]^2.
inline std::vector<Vec2> random_inner_points(const PatchBoundary& boundary, std::uint64_t seed, int n,
                                             double distance) {
  std::mt19937_64 random(seed);
  std::vector<Vec2> inner;
  for (int tries = 0; tries < n; ++tries) {
    const Vec2 p = {2 * shapes::uniform(random) - 1, 2 * shapes::uniform(random) - 1};
    bool inside = false, apart = true;
    for (const auto& [i, j] : boundary.edges) {
      const Vec2 a = boundary.points[i], b = boundary.points[j];
      if ((a.y > p.y) != (b.y > p.y) && (orient2d(a, b, p) > 0) == (b.y > a.y)) inside = !inside;
      apart = apart && norm(p - a) > distance && shapes::segment_distance(p, a, b) > distance / 2;
    }
    for (const Vec2 q : inner) apart = apart && norm(p - q) > distance;
    if (inside && apart) inner.push_back(p);
  }
  return inner;
}

}  // namespace delquad::testing_support
