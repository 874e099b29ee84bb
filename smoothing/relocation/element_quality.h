#pragma once

#include <algorithm>

#include "geometry/mesh/quad_topology.h"
#include "smoothing/relocation/quad_relocation.h"

namespace delquad {

/// Of one element or of several.
struct ElementQuality {
  double value = 0;       ///< eta - 1.5 * (size deviation), or the sum of it
  double least_sine = 1;  ///< of all corners
  double longest = 0;     ///< side, over delta'
  double crowding = 0;    ///< QuadRelocation::crowding(), or the sum of it
  void add(const ElementQuality& other) {
    value += other.value;
    least_sine = std::min(least_sine, other.least_sine);
    longest = std::max(longest, other.longest);
    crowding += other.crowding;
  }
};

/// The size deviation is the mean over the sides of 1 - min(l, 1/l), l = length / delta'. Its weight: with 1,
/// edits that are weighed by this pay for regular vertices with tau.
ElementQuality element_quality(const QuadTopology& mesh, const QuadRelocation& relocation, int element);

}  // namespace delquad
