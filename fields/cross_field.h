#pragma once

#include <cmath>

#include "mesh/vec.h"

namespace delquad {

/// A cross: four directions theta + k pi/2, stored as exp(4 i theta), not necessarily of unit length.
/// [Section 3]
struct Cross {
  double c = 1;  ///< cos 4 theta
  double s = 0;  ///< sin 4 theta
  static Cross from_angle(double theta) { return {std::cos(4 * theta), std::sin(4 * theta)}; }
  /// One of the four directions along d, which is not zero; free of rounding when d lies along an axis or
  /// diagonal.
  static Cross along(Vec2 d) {
    const double n = std::hypot(d.x, d.y);
    const Vec2 e = {d.x / n, d.y / n};
    const Vec2 squared = {e.x * e.x - e.y * e.y, 2 * e.x * e.y};
    return {squared.x * squared.x - squared.y * squared.y, 2 * squared.x * squared.y};
  }
  /// theta in (-pi/4, pi/4], radians.
  double angle() const { return std::atan2(s, c) / 4; }
};

inline Cross operator+(Cross a, Cross b) { return {a.c + b.c, a.s + b.s}; }

/// The wanted directions of the quads' edges in the parameter plane of a patch.
class CrossField {
 public:
  virtual ~CrossField() = default;
  /// `hint`: as in SizeField::at.
  virtual Cross at(Vec2 u, int& hint) const = 0;
};

}  // namespace delquad
