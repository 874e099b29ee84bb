// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "base/predicates.h"

// This header asks whether a point lies in a polygon. Planar regions and washers use it.

namespace delquad {

/// Returns whether a point lies inside a closed polygon, by exact predicates; points on its sides may count
/// either way.
inline bool encloses(const std::vector<Vec2>& loop, Vec2 x) {
  bool inside = false;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Vec2 a = loop[i], b = loop[(i + 1) % loop.size()];
    if ((a.y <= x.y) != (b.y <= x.y) && (orient2d(a, b, x) > 0) == (b.y > a.y)) inside = !inside;
  }
  return inside;
}

}  // namespace delquad
