// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cassert>
#include <initializer_list>
#include <span>
#include <vector>

#include "delquad/mesh.h"

// This header has axis-aligned boxes. Most modules use it.

namespace delquad {

/// Returns the coordinate along an axis, from 0.
inline double coordinate(const Vec2& p, int axis) { return axis == 0 ? p.x : p.y; }
inline double coordinate(const Vec3& p, int axis) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }
/// Returns the lower, or upper, coordinates of both points.
inline Vec2 lower(const Vec2& a, const Vec2& b) { return {std::min(a.x, b.x), std::min(a.y, b.y)}; }
inline Vec2 upper(const Vec2& a, const Vec2& b) { return {std::max(a.x, b.x), std::max(a.y, b.y)}; }
inline Vec3 lower(const Vec3& a, const Vec3& b) {
  return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
}
inline Vec3 upper(const Vec3& a, const Vec3& b) {
  return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
}

/// Axis-aligned box in the plane or in space.
template <class V>
struct Box {
  static constexpr int kAxes = sizeof(V) / sizeof(double);
  V low, high;

  /// Returns the smallest box around the points, of which there is at least one.
  static Box around(std::initializer_list<V> points) { return around(std::span(points)); }
  static Box around(std::span<const V> points) {
    assert(!points.empty());
    Box box{points[0], points[0]};
    for (const V& p : points) box.add(p);
    return box;
  }
  /// Extends the box to a point.
  void add(const V& p) { low = lower(low, p), high = upper(high, p); }
  V size() const { return high - low; }
  /// Returns the box, larger by this length >= 0 on all sides.
  Box grown(double by) const {
    V more;
    if constexpr (kAxes == 2)
      more = {by, by};
    else
      more = {by, by, by};
    return {low - more, high + more};
  }
  /// Returns whether both share a point.
  bool overlaps(const Box& other) const {
    for (int k = 0; k < kAxes; ++k)
      if (coordinate(low, k) > coordinate(other.high, k) || coordinate(other.low, k) > coordinate(high, k))
        return false;
    return true;
  }
  /// Returns the square of the distance from x to the box; 0 inside.
  double distance2(const V& x) const {
    double sum = 0;
    for (int k = 0; k < kAxes; ++k) {
      const double d =
          std::max({coordinate(low, k) - coordinate(x, k), 0.0, coordinate(x, k) - coordinate(high, k)});
      sum += d * d;
    }
    return sum;
  }
};

/// Returns the diagonal of the bounding box of points; 0 without points.
template <class V>
double diagonal(const std::vector<V>& points) {
  return points.empty() ? 0 : norm(Box<V>::around(std::span(points)).size());
}

}  // namespace delquad
