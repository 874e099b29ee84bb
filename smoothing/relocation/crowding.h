#pragma once

#include <algorithm>

#include "geometry/mesh/quad_corners.h"

namespace delquad {

/// How near the ends of an inner side come to each other, against the longest side of its element or delta,
/// as far as this is not more than twice that (what is far too small all over is not crowded). In `narrow`
/// places elements are thin as a whole: `width` (area over longest side) counts there. 0: the side is as long
/// as kKeptSide asks for, else by what part more it would have to be longer, 99 at most. It is that steep so
/// that no side gets shorter for the sake of others.
inline double crowding_of(double length, double delta, double longest, bool narrow = false,
                          double width = 0) {
  constexpr double kLeastPart = 0.01;
  constexpr double kThin = 4;  // longest side over width: from there on an element is thin
  double reach = std::clamp(delta, longest, 2 * longest);
  if (narrow) reach = std::min(reach, kThin * width);
  return 1 / std::clamp(length / std::max(kKeptSide * reach, kTinyLength), kLeastPart, 1.0) - 1;
}

}  // namespace delquad
