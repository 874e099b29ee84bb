// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "delquad/mesh.h"

// This header finds points within a tolerance. Outlines use it.

namespace delquad {

/// Finds points by square cells as wide as the tolerance, a length > 0, from the corner `low` on.
class PointGrid {
 public:
  PointGrid(Vec2 low, double tolerance) : low_(low), tolerance_(tolerance) {}

  void add(Vec2 x, int number) { cells_[cell(x)].push_back(number); }
  /// Returns the first of the added numbers whose point in `points` is within the tolerance of x; -1: none.
  int find(Vec2 x, const std::vector<Vec2>& points) const {
    int found = -1;
    const auto [cx, cy] = cell(x);
    for (long long i = cx - 1; i <= cx + 1; ++i)
      for (long long j = cy - 1; j <= cy + 1; ++j)
        if (const auto at = cells_.find({i, j}); at != cells_.end())
          for (const int k : at->second)
            if (norm(points[k] - x) <= tolerance_ && (found < 0 || k < found)) found = k;
    return found;
  }

 private:
  std::pair<long long, long long> cell(Vec2 x) const {
    const Vec2 d = x - low_;
    return {static_cast<long long>(std::floor(d.x / tolerance_)),
            static_cast<long long>(std::floor(d.y / tolerance_))};
  }

  Vec2 low_;
  double tolerance_;
  std::map<std::pair<long long, long long>, std::vector<int>> cells_;
};

}  // namespace delquad
