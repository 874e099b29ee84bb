// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "delquad/fields.h"
#include "delquad/mesh.h"
#include "geometry/mesh/quad_topology.h"

// This header has angles, lengths and qualities of single quads. Most modules use it.

namespace delquad {

/// Length that shorter sides count as, to avoid a division by 0.
inline constexpr double kTinyLength = 1e-300;

/// Returns the normal of a quad, of any length, from its diagonals; zero in the plane.
inline Vec2 quad_normal(Vec2, Vec2) { return {}; }
inline Vec3 quad_normal(const Vec3& first, const Vec3& second) { return cross(first, second); }

/// A corner between the unit vectors of its incoming and its outgoing side.
template <class Vec>
struct QuadCorner;

template <>
struct QuadCorner<Vec2> {
  QuadCorner(Vec2 in, Vec2 out, Vec2 /*normal*/) : sine(cross(in, out)) {}
  /// Returns a vector turned by 90 degrees in the corner's plane.
  Vec2 quarter_turn(Vec2 v) const { return perp(v); }
  double sine;  ///< sine of its angle, negative if it turns against the normal
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

/// Returns eta of a quad whose worst corner differs by so many radians from a right angle [remacle2013,
/// equation (4)].
inline double eta_of_deviation(double radians) { return 1 - radians * 2 / std::numbers::pi; }

/// Returns eta of a quad by the sine of its worst corner. It is 1 for 90 degrees, 0 for 0 and for 180, and
/// negative if the corner is reflex. A sine beyond +-1, by rounding, counts as +-1.
inline double eta_of_sine(double sine) {
  return 2 / std::numbers::pi * std::asin(std::clamp(sine, -1.0, 1.0));
}
/// Returns the sine of the worst corner for this eta, from -1 to 1.
inline double sine_of_eta(double eta) { return std::sin(eta * std::numbers::pi / 2); }

/// A corner of a smaller angle (radians) takes one quad only (own rule). If two shared it evenly, each would
/// have an eta below 0.1, half of the angle over 90 degrees.
inline constexpr double kLeastSharedAngle = 18 * std::numbers::pi / 180;

/// Returns the number >= 1 of quads that best share an angle of so many right angles.
inline int ideal_quads(double right_angles) {
  return std::max(1, static_cast<int>(std::lround(right_angles)));
}

/// Least length of inner sides over delta, or over the element's longest side; ends of shorter sides nearly
/// coincide. Stages keep sides a quarter longer, since they know delta at vertices only.
inline constexpr double kShortSide = 0.1, kKeptSide = 1.25 * kShortSide;

/// Returns whether a quad is beyond limits. `shortest` and `longest` are sides over the wanted size, `sine`
/// the least of its corners.
inline bool is_beyond(const QuadLimits& limits, double shortest, double longest, double aspect, double sine) {
  return shortest < limits.shortest || longest > limits.longest || aspect > limits.aspect ||
         (sine < std::numbers::pi / 2 * limits.eta && sine < sine_of_eta(limits.eta));
}

/// Returns the sines of an element's corners, negative if reflex or inverted. The fourth of a triangle is 1.
std::array<double, 4> corner_sines(const QuadTopology& mesh, int element);
/// Returns the least of these sines.
double least_sine(const QuadTopology& mesh, int element);

/// Returns the sines of a quad's corners, in space against quad_normal().
template <class Vec>
std::array<double, 4> corner_sines(const std::array<Vec, 4>& at) {
  const Vec normal = quad_normal(at[2] - at[0], at[3] - at[1]);
  std::array<Vec, 4> side;
  for (int k = 0; k < 4; ++k) {
    side[k] = at[(k + 1) % 4] - at[k];
    side[k] = (1 / std::max(norm(side[k]), kTinyLength)) * side[k];
  }
  std::array<double, 4> sines;
  for (int k = 0; k < 4; ++k) sines[k] = QuadCorner<Vec>(side[(k + 3) % 4], side[k], normal).sine;
  return sines;
}

}  // namespace delquad
