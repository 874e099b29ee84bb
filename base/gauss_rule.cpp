// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/gauss_rule.h"

#include <algorithm>
#include <boost/math/special_functions/legendre.hpp>

namespace delquad {

std::vector<GaussPoint> gauss_rule(int n) {
  std::vector<GaussPoint> rule;
  for (const double x : boost::math::legendre_p_zeros<double>(n)) {
    const double slope = boost::math::legendre_p_prime(n, x), weight = 1 / ((1 - x * x) * slope * slope);
    rule.push_back({(1 + x) / 2, weight});
    if (x > 0) rule.push_back({(1 - x) / 2, weight});
  }
  std::ranges::sort(rule, {}, &GaussPoint::at);
  return rule;
}

}  // namespace delquad
