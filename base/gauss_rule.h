#pragma once

#include <vector>

namespace delquad {

struct GaussPoint {
  double at, weight;
};

/// Gauss's rule of n points on [0, 1], in ascending order: exact for polynomials of degree 2 n - 1. n >= 1.
std::vector<GaussPoint> gauss_rule(int n);

}  // namespace delquad
