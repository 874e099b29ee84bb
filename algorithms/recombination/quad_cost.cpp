#include "algorithms/recombination/quad_cost.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace delquad {

namespace {

constexpr double kRightAngle = std::numbers::pi / 2;

struct Corner {
  double cross, dot;  ///< of the sides that leave the corner, forwards and backwards
};

Corner corner(Vec2 before, Vec2 at, Vec2 after) {
  const Vec2 u = after - at, v = before - at;
  return {cross(u, v), dot(u, v)};
}

/// |angle - 90 deg|, the angle in [0, 360) degrees.
double deviation(Corner c) {
  const double angle = std::atan2(c.cross, c.dot);
  return std::abs((angle < 0 ? angle + 2 * std::numbers::pi : angle) - kRightAngle);
}

}  // namespace

double signed_eta(Vec2 a, Vec2 b, Vec2 c, Vec2 d) {
  const Corner corners[4] = {corner(d, a, b), corner(a, b, c), corner(b, c, d), corner(c, d, a)};
  // In a convex quad the tangent of the deviation is |dot| / cross: one arc tangent does for all corners.
  double worst = 0;
  bool convex = true;
  for (const Corner& k : corners) {
    convex = convex && k.cross > 0;
    worst = std::max(worst, std::abs(k.dot) / k.cross);
  }
  if (convex) return 1 - std::atan(worst) / kRightAngle;
  worst = 0;
  for (const Corner& k : corners) worst = std::max(worst, deviation(k));
  return 1 - worst / kRightAngle;
}

}  // namespace delquad
