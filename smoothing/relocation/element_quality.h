// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>

#include "geometry/mesh/quad_corners.h"
#include "geometry/mesh/quad_topology.h"
#include "smoothing/relocation/quad_relocation.h"

// This header measures elements for edits of quads. Clean-up, stage Q, repairs and relocation use it.

namespace delquad {

/// Quality of one element in the parameter plane, or sums and minima over several.
struct ElementQuality {
  double value = 0;       ///< eta - 1.5 * (size deviation)
  double least_sine = 1;  ///< least of all corners, -1 to 1; negative if reflex or inverted
  int failing = 0;        ///< 1 if is_beyond() limits
  int thin = 0;           ///< 1 if its shortest side is too short, which angles cannot repair
  double crowding = 0;    ///< QuadRelocation::crowding()
  void add(const ElementQuality& other) {
    value += other.value;
    least_sine = std::min(least_sine, other.least_sine);
    failing += other.failing;
    thin += other.thin;
    crowding += other.crowding;
  }
};

/// Measures a live element. The size deviation is the mean over sides of 1 - min(l, 1/l), l = length /
/// delta'. With a weight of 1, edits would pay for regular vertices with tau.
ElementQuality element_quality(const QuadTopology& mesh, const QuadRelocation& relocation, int element);
/// Measures the first n corners, 3 or 4, with their delta' > 0 and without surroundings. The crowding is 1 if
/// there may be some, else 0.
ElementQuality quality_of(const std::array<Vec2, 4>& at, const std::array<double, 4>& delta,
                          const QuadLimits& limits, int n = 4);

/// Returns how close the ends of an inner side are, by an own measure; lengths are in the parameter plane.
/// The reference is delta, clamped to between one and two times the longest side, so a small element is not
/// crowded. In `narrow` places, `width` (area over longest side) limits it, as elements are thin. The value
/// is 0 if the side is as long as kKeptSide asks, else the missing part, 99 at most. It is steep, so that no
/// side shrinks in favor of others.
inline double crowding_of(double length, double delta, double longest, bool narrow = false,
                          double width = 0) {
  constexpr double kLeastPart = 0.01;
  constexpr double kNarrowAspect = 4;  // longest side over width of a thin element
  double reach = std::clamp(delta, longest, 2 * longest);
  if (narrow) reach = std::min(reach, kNarrowAspect * width);
  return 1 / std::clamp(length / std::max(kKeptSide * reach, kTinyLength), kLeastPart, 1.0) - 1;
}

}  // namespace delquad
