// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "delquad/mesh.h"

// This header finds points that are far from all others. Readers of surfaces use it.

namespace delquad {

/// Factor between distances of stray points and of the others.
inline constexpr double kStray = 1e4;

struct StrayPoint {
  int point;     ///< index
  double times;  ///< its distance over the distance of the farthest other point
};

/// Returns the points of elements that are too far out to be intended, ascending (own rule). They are less
/// than a quarter of all. No point lies between them and the others for a factor of kStray in distance from
/// the medians. All points must be finite.
std::vector<StrayPoint> stray_points(const Mesh& mesh);

/// Returns "the point (0, 0, 1e+30) is 1e+30 times as far out as the others: is a number damaged?".
std::string describe(const StrayPoint& stray, const Mesh& mesh);

}  // namespace delquad
