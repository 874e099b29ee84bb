// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "delquad/mesh.h"

// This header finds points that are far from all others. Readers of surfaces use it.

namespace delquad {

/// How many times as far out as the others a point must be.
inline constexpr double kStray = 1e4;

struct StrayPoint {
  int point;     ///< index
  double times;  ///< as far out as the others
};

/// Returns the points of elements that can hardly be meant, ascending. They are less than a quarter of all.
/// Between them and the others there is nothing for a factor of kStray in distance from the middle (the
/// medians). Parts of different sizes lie within that, or have others between; a number with a wrong exponent
/// does not. All points must be finite.
std::vector<StrayPoint> stray_points(const Mesh& mesh);

/// Returns "the point (0, 0, 1e+30) is 1e+30 times as far out as the others: is a number damaged?"
std::string describe(const StrayPoint& stray, const Mesh& mesh);

}  // namespace delquad
