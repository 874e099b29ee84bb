#pragma once

#include <algorithm>
#include <array>

#include "geometry/mesh/quad_corners.h"
#include "geometry/mesh/quad_topology.h"
#include "smoothing/relocation/quad_relocation.h"

namespace delquad {

/// Of one element or of several.
struct ElementQuality {
  double value = 0;       ///< eta - 1.5 * (size deviation), or the sum of it
  double least_sine = 1;  ///< of all corners
  int failing = 0;        ///< 1: is_beyond_asked(); or the sum
  int thin = 0;           ///< 1: by its shortest side, which no angle mends; or the sum
  double crowding = 0;    ///< QuadRelocation::crowding(), or the sum of it
  void add(const ElementQuality& other) {
    value += other.value;
    least_sine = std::min(least_sine, other.least_sine);
    failing += other.failing;
    thin += other.thin;
    crowding += other.crowding;
  }
};

/// The size deviation is the mean over the sides of 1 - min(l, 1/l), l = length / delta'. Its weight: with 1,
/// edits that are weighed by this pay for regular vertices with tau.
ElementQuality element_quality(const QuadTopology& mesh, const QuadRelocation& relocation, int element);
/// Of n corners and the delta' there, without what is around: crowding is 0 or 1, which is perhaps some.
ElementQuality quality_of(const std::array<Vec2, 4>& at, const std::array<double, 4>& delta, int n = 4);

/// How near the ends of an inner side come to each other, against the longest side of its element or delta,
/// as far as this is not more than twice that (what is far too small all over is not crowded). In `narrow`
/// places elements are thin as a whole: `width` (area over longest side) counts there. 0: the side is as long
/// as kKeptSide asks for, else by what part more it would have to be longer, 99 at most. It is that steep so
/// that no side gets shorter for the sake of others.
inline double crowding_of(double length, double delta, double longest, bool narrow = false,
                          double width = 0) {
  constexpr double kLeastPart = 0.01;
  constexpr double kNarrowAspect = 4;  // longest side over width: from there on an element is thin
  double reach = std::clamp(delta, longest, 2 * longest);
  if (narrow) reach = std::min(reach, kNarrowAspect * width);
  return 1 / std::clamp(length / std::max(kKeptSide * reach, kTinyLength), kLeastPart, 1.0) - 1;
}

}  // namespace delquad
