#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "mesh/vec.h"

namespace delquad {

/// Normal of a quad from its diagonals; of no use in the plane.
inline Vec2 quad_normal(Vec2, Vec2) { return {}; }
inline Vec3 quad_normal(const Vec3& first, const Vec3& second) { return cross(first, second); }

/// A corner between unit vectors, the side that comes in and the one that goes out.
template <class Vec>
struct QuadCorner;

template <>
struct QuadCorner<Vec2> {
  QuadCorner(Vec2 in, Vec2 out, Vec2 /*normal*/) : sine(cross(in, out)) {}
  /// A vector turned by 90 degrees in the corner's plane.
  Vec2 quarter_turn(Vec2 v) const { return perp(v); }
  double sine;  ///< negative where the corner turns against the normal
};

template <>
struct QuadCorner<Vec3> {
  QuadCorner(const Vec3& in, const Vec3& out, const Vec3& normal) : turn(cross(in, out)) {
    sine = std::copysign(norm(turn), dot(turn, normal));
  }
  Vec3 quarter_turn(const Vec3& v) const { return cross((1 / sine) * turn, v); }
  Vec3 turn;
  double sine;
};

/// Sines of a quad's corners.
template <class Vec>
std::array<double, 4> corner_sines(const std::array<Vec, 4>& at) {
  constexpr double kTiny = 1e-300;
  const Vec normal = quad_normal(at[2] - at[0], at[3] - at[1]);
  std::array<Vec, 4> side;
  for (int k = 0; k < 4; ++k) {
    side[k] = at[(k + 1) % 4] - at[k];
    side[k] = (1 / std::max(norm(side[k]), kTiny)) * side[k];
  }
  std::array<double, 4> sines;
  for (int k = 0; k < 4; ++k) sines[k] = QuadCorner<Vec>(side[(k + 3) % 4], side[k], normal).sine;
  return sines;
}

}  // namespace delquad
