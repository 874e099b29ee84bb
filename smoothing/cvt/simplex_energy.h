// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>

#include "delquad/mesh.h"

// This header integrates powers over triangles. The Lp energy uses it.

namespace delquad {

/// An integral over a triangle (0, first, second) and its derivatives by two corners. The derivative by the
/// third one, the origin, is minus their sum if the corners move with it.
struct SimplexEnergy {
  double value = 0;
  Vec2 by_first, by_second;
};

/// Numbers for both axes, processed together.
using BothAxes = double __attribute__((vector_size(16)));

/// Coefficients of S below and of its derivatives by both arguments. All are positive, so nothing cancels.
/// They are compile-time constants, since -frounding-math forbids assumptions about rounding.
template <int P>
struct OddBinomials {
  std::array<double, P / 2> by_ss{}, by_dd{};
  double value_scale = 1.0 / (P / 2 * (P + 1) * (P + 2) * (2LL << P)), derivative_scale = P * value_scale;

  constexpr OddBinomials() {
    double binomial = 1;
    for (int k = 0; k <= P; ++k) {
      binomial = binomial * (P + 1 - k) / (k + 1);  // P + 1 over k + 1
      if (k % 2 != 0) continue;
      const int j = k / 2;
      if (j < P / 2) by_ss[j] = (P / 2 - j) * binomial;
      if (j > 0) by_dd[j - 1] = j * binomial;
    }
  }
};

/// Returns the integral of x^P + y^P over the triangle (0, first, second), negative if it is clockwise:
///
///     J / ((P + 1) (P + 2)) sum over k = 0 .. P of (x1^k x2^(P-k) + y1^k y2^(P-k)),  J = first x second
///
/// It follows from the integrals of b1^k b2^(P-k), b the barycentric coordinates [levy2010], for even P. With
/// s = x1 + x2 and d = x2 - x1 the sum is 2^-P times
///
///     S(s^2, d^2) = sum over j = 0 .. P/2 of (P + 1 over 2 j + 1) s^(P - 2 j) d^(2 j)
///
/// and takes a third of the multiplications, derivatives included.
template <int P>
SimplexEnergy simplex_energy(Vec2 first, Vec2 second) {
  static_assert(P >= 2 && P % 2 == 0);
  static constexpr OddBinomials<P> kOdd;
  const BothAxes s = {first.x + second.x, first.y + second.y}, d = {second.x - first.x, second.y - first.y};
  const BothAxes ss = s * s, dd = d * d;
  // Derivatives of S, homogeneous, by Horner's rule in s^2; S by Euler's formula.
  BothAxes by_ss = {kOdd.by_ss[0], kOdd.by_ss[0]}, by_dd = {kOdd.by_dd[0], kOdd.by_dd[0]}, power = dd;
  for (std::size_t j = 1; j < P / 2; ++j) {
    by_ss = by_ss * ss + kOdd.by_ss[j] * power;
    by_dd = by_dd * ss + kOdd.by_dd[j] * power;
    power *= dd;
  }
  const BothAxes sums = ss * by_ss + dd * by_dd;
  const double twice_j = s[0] * d[1] - s[1] * d[0];
  const double sum = kOdd.value_scale * (sums[0] + sums[1]), factor = kOdd.derivative_scale * twice_j;
  const BothAxes by_s = sum * BothAxes{d[1], -d[0]} + factor * s * by_ss;
  const BothAxes by_d = sum * BothAxes{-s[1], s[0]} + factor * d * by_dd;
  const BothAxes by_first = by_s - by_d, by_second = by_s + by_d;
  return {twice_j * sum, {by_first[0], by_first[1]}, {by_second[0], by_second[1]}};
}

}  // namespace delquad
