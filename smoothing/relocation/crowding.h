#pragma once

#include <algorithm>

#include "mesh/quad_corners.h"

namespace delquad {

/// How near the ends of an inner side come to each other, against the longest side of its element or delta,
/// as far as this is not more than twice that (what is far too small all over is not crowded): 0 where it is
/// as long as kKeptSide asks for, else by what part more it would have to be longer, 99 at most. It is that
/// steep so that no side gets shorter for the sake of others.
inline double crowding_of(double length, double delta, double longest) {
  constexpr double kLeastPart = 0.01;
  const double wanted = kKeptSide * std::clamp(delta, longest, 2 * longest);
  return 1 / std::clamp(length / std::max(wanted, kTinyLength), kLeastPart, 1.0) - 1;
}

}  // namespace delquad
