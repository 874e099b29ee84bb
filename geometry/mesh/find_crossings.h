// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "delquad/mesh.h"

// This header finds triangles that cross. Checks of bodies and sweeps use it.

namespace delquad {

/// An edge of the first triangle goes through the second one, or both lie on each other.
struct Crossing {
  int first, second;
  Vec3 at;
  bool is_flat = false;  ///< they lie on each other
};

/// Triangles that need not be told apart.
using MayCross = std::function<bool(int, int)>;

/// Returns the triangles with an edge that goes through another triangle, both ends beside its plane, decided
/// exactly. If there are several others it names the first. Triangles may touch, and lie on each other; with
/// a positive `contact`, pairs whose insides overlap in one plane, within that length, are told, too. Pairs
/// that `may_cross` are left out; several threads call it.
std::vector<Crossing> find_crossings(const std::vector<Vec3>& points,
                                     const std::vector<std::array<int, 3>>& triangles,
                                     const MayCross& may_cross, double contact = 0);
/// Returns the first of them.
std::optional<Crossing> find_crossing(
    const std::vector<Vec3>& points, const std::vector<std::array<int, 3>>& triangles,
    const MayCross& may_cross = [](int, int) { return false; });

}  // namespace delquad
