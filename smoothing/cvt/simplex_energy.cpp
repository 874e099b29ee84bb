#include "smoothing/cvt/simplex_energy.h"

#include <cassert>

namespace delquad {

double simplex_moment(int m, Vec2 first, Vec2 second) {
  assert(m >= 0);
  // Horner: the sum over k of x1^k x2^(m-k).
  double sum = 1, power = 1;
  for (int k = 1; k <= m; ++k) {
    power *= first.x;
    sum = sum * second.x + power;
  }
  return cross(first, second) / ((m + 1) * (m + 2)) * sum;
}

}  // namespace delquad
