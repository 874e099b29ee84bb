// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

// This header has Gauss's rules of quadrature. Finite elements and error estimates use it.

namespace delquad {

/// A place in [0, 1] and its weight; the weights of a rule sum up to 1.
struct GaussPoint {
  double at, weight;
};

/// Returns Gauss's rule of n >= 1 points on [0, 1], ascending. It is exact for polynomials of degree 2 n - 1.
std::vector<GaussPoint> gauss_rule(int n);

}  // namespace delquad
