// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "delquad/mesh.h"

// This header finds triangles that cross. Checks of bodies and sweeps use it.

namespace delquad {

/// Two triangles that cross: an edge of one goes through the other, or both lie on each other.
struct Crossing {
  int first, second;
  Vec3 at;
  bool is_flat = false;  ///< they lie on each other
};

/// Returns whether two triangles may cross.
using MayCross = std::function<bool(int, int)>;

/// Returns each triangle with an edge that goes through another triangle, with both ends off its plane
/// (exact), and the first such triangle. Triangles that touch do not cross. With a length `contact` > 0,
/// triangles that overlap in one plane within it cross, too. Several threads call `may_cross`.
std::vector<Crossing> find_crossings(const std::vector<Vec3>& points,
                                     const std::vector<std::array<int, 3>>& triangles,
                                     const MayCross& may_cross, double contact = 0);
/// Returns the first crossing; nothing if there is none.
std::optional<Crossing> find_crossing(
    const std::vector<Vec3>& points, const std::vector<std::array<int, 3>>& triangles,
    const MayCross& may_cross = [](int, int) { return false; });

}  // namespace delquad
