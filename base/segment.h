// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "delquad/mesh.h"

// This header measures distances to segments. Most modules use it.

namespace delquad {

/// Returns the parameter in [0, 1] of the point nearest to x on segment a, b; 0 if a equals b.
template <class Vec>
double nearest_part(const Vec& x, const Vec& a, const Vec& b) {
  const Vec d = b - a;
  const double length2 = dot(d, d);
  return length2 > 0 ? std::clamp(dot(x - a, d) / length2, 0.0, 1.0) : 0;
}
/// Returns this point.
template <class Vec>
Vec nearest_on_segment(const Vec& x, const Vec& a, const Vec& b) {
  return a + nearest_part(x, a, b) * (b - a);
}
/// Returns the distance from x to segment a, b.
template <class Vec>
double distance_to_segment(const Vec& x, const Vec& a, const Vec& b) {
  return norm(x - nearest_on_segment(x, a, b));
}

/// Returns the vector from a corner along its bisector, as long as this part, > 0, of its shorter side. The
/// inside is on the left of the path from `back` over the corner to `ahead`.
inline Vec2 into_corner(Vec2 back, Vec2 corner, Vec2 ahead, double part) {
  const Vec2 out = ahead - corner, in = back - corner;
  const double from = std::atan2(out.y, out.x);
  double turn = std::atan2(in.y, in.x) - from;
  if (turn <= 0) turn += 2 * std::numbers::pi;
  const double angle = from + turn / 2;
  return part * std::min(norm(out), norm(in)) * Vec2{std::cos(angle), std::sin(angle)};
}

}  // namespace delquad
