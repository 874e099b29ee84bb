// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <limits>

#include "delquad/mesh.h"

// This header has exact predicates of the plane. All decisions of topology use it.

namespace delquad {

namespace exact {

/// Decide exactly, by CGAL, the few calls that the filters below cannot decide; results as for the functions
/// below.
int orient2d(Vec2 a, Vec2 b, Vec2 c);
int in_circle(Vec2 a, Vec2 b, Vec2 c, Vec2 d);

// Forward error bounds of the floating-point determinants, relative to their permanents [shewchuk1997, bounds
// A].
inline constexpr double kEps = std::numeric_limits<double>::epsilon() / 2;
inline constexpr double kOrientBound = (3 + 16 * kEps) * kEps;
inline constexpr double kInCircleBound = (10 + 96 * kEps) * kEps;
/// Below this, products may have lost bits to underflow, and relative bounds do not hold.
inline constexpr double kUnderflowGuard = 1e-280;

}  // namespace exact

/// Returns the sign of the exact area of the triangle a, b, c: +1 counterclockwise, 0 collinear, -1
/// clockwise.
inline int orient2d(Vec2 a, Vec2 b, Vec2 c) {
  const double left = (a.x - c.x) * (b.y - c.y);
  const double right = (a.y - c.y) * (b.x - c.x);
  const double det = left - right;
  const double bound = exact::kOrientBound * (std::abs(left) + std::abs(right));
  if (std::abs(det) > bound && bound > exact::kUnderflowGuard) return det > 0 ? 1 : -1;
  return exact::orient2d(a, b, c);
}

/// Returns in_circle(), or 0 if rounding leaves the sign open, by the bounds of [shewchuk1997].
inline int in_circle_filtered(Vec2 a, Vec2 b, Vec2 c, Vec2 d) {
  const Vec2 ad = a - d, bd = b - d, cd = c - d;
  const double bc1 = bd.x * cd.y, bc2 = cd.x * bd.y;
  const double ca1 = cd.x * ad.y, ca2 = ad.x * cd.y;
  const double ab1 = ad.x * bd.y, ab2 = bd.x * ad.y;
  const double a_lift = dot(ad, ad), b_lift = dot(bd, bd), c_lift = dot(cd, cd);
  const double det = a_lift * (bc1 - bc2) + b_lift * (ca1 - ca2) + c_lift * (ab1 - ab2);
  const double permanent = (std::abs(bc1) + std::abs(bc2)) * a_lift +
                           (std::abs(ca1) + std::abs(ca2)) * b_lift +
                           (std::abs(ab1) + std::abs(ab2)) * c_lift;
  const double bound = exact::kInCircleBound * permanent;
  if (std::abs(det) > bound && bound > exact::kUnderflowGuard) return det > 0 ? 1 : -1;
  return 0;
}

/// Returns +1 if d lies strictly inside the circle through the counterclockwise triangle a, b, c, 0 on it, -1
/// outside.
inline int in_circle(Vec2 a, Vec2 b, Vec2 c, Vec2 d) {
  const int sign = in_circle_filtered(a, b, c, d);
  return sign != 0 ? sign : exact::in_circle(a, b, c, d);
}

}  // namespace delquad
