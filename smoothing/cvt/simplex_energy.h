#pragma once

#include <array>

#include "delquad/mesh.h"

namespace delquad {

/// x^0 to x^P and y^0 to y^P of a corner.
template <int P>
struct Powers {
  Vec2 u;
  std::array<double, P + 1> x, y;

  Powers() = default;
  explicit Powers(Vec2 corner) : u(corner) {
    x[0] = y[0] = 1;
    for (int k = 1; k <= P; ++k) {
      x[k] = x[k - 1] * u.x;
      y[k] = y[k - 1] * u.y;
    }
  }
};

/// An integral over a triangle and its derivatives by two of the corners; that by the third, the origin, is
/// minus their sum where the corners move with it.
struct SimplexEnergy {
  double value = 0;
  Vec2 by_first, by_second;
};

/// Integral of x^P + y^P over the triangle (0, first, second), negative when it is clockwise:
///
///     J / ((P + 1) (P + 2)) sum over k = 0 .. P of (x1^k x2^(P-k) + y1^k y2^(P-k)),  J = first x second
///
/// which follows from the integrals of b1^k b2^(P-k), b the barycentric coordinates. P even. [levy2010]
template <int P>
SimplexEnergy simplex_energy(const Powers<P>& first, const Powers<P>& second) {
  static_assert(P >= 2 && P % 2 == 0);
  const auto &x1 = first.x, &y1 = first.y, &x2 = second.x, &y2 = second.y;
  double sum = 0;
  for (int k = 0; k <= P; ++k) sum += x1[k] * x2[P - k] + y1[k] * y2[P - k];
  Vec2 d1, d2;  // of the sum
  for (int k = 0; k < P; ++k) {
    const double x = x1[k] * x2[P - 1 - k], y = y1[k] * y2[P - 1 - k];
    d1 += (k + 1) * Vec2{x, y};
    d2 += (P - k) * Vec2{x, y};
  }
  constexpr double kScale = 1.0 / ((P + 1) * (P + 2));
  const double area = kScale * cross(first.u, second.u);
  return {area * sum, kScale * sum * Vec2{second.u.y, -second.u.x} + area * d1,
          kScale * sum * Vec2{-first.u.y, first.u.x} + area * d2};
}

/// Integral of x^m over the triangle (0, first, second), negative when it is clockwise; m >= 0.
double simplex_moment(int m, Vec2 first, Vec2 second);

}  // namespace delquad
