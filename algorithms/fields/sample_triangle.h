// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>

#include "delquad/mesh.h"

// This header divides triangles to look at a field closely. Fields and metrics use it.

namespace delquad {

/// The corners of a triangle, counterclockwise.
using Corners = std::array<Vec2, 3>;

inline Corners corners_of(const TriPatch& tri, const std::array<int, 3>& v) {
  return {tri.points[v[0]], tri.points[v[1]], tri.points[v[2]]};
}

inline double longest_side(const Corners& c) {
  return std::max({norm(c[1] - c[0]), norm(c[2] - c[1]), norm(c[0] - c[2])});
}

/// Returns the slope of the linear function with these values at the corners of a triangle
/// (counterclockwise). It is zero on a triangle without area.
inline Vec2 slope(const Corners& c, const std::array<double, 3>& values) {
  const double twice_area = cross(c[1] - c[0], c[2] - c[0]);
  if (!(twice_area > 0)) return {0, 0};
  return (1 / twice_area) *
         ((values[1] - values[0]) * perp(c[0] - c[2]) + (values[2] - values[0]) * perp(c[1] - c[0]));
}

/// Returns the middles of the sides, each opposite to the corner of its index.
inline Corners middles(const Corners& c) {
  return {0.5 * (c[1] + c[2]), 0.5 * (c[2] + c[0]), 0.5 * (c[0] + c[1])};
}

inline std::array<Corners, 4> quarters(const Corners& c) {
  const Corners m = middles(c);
  return {Corners{c[0], m[2], m[1]}, Corners{m[2], c[1], m[0]}, Corners{m[1], m[0], c[2]}, m};
}

}  // namespace delquad
