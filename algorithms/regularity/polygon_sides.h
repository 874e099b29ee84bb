// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

// This header relates the sides of convex polygons to grids and stars. Patterns and layouts use it.

namespace delquad {

/// Edges of each side of a convex polygon, from its first corner, `start`, on the outline.
struct PolygonSides {
  std::vector<int> edges;
  int start = 0;
};

/// Returns the sides for turns as in Outline; nothing if a vertex is concave or fewer than two are corners.
std::optional<PolygonSides> sides_of(std::span<const int> turn);

/// Returns the distances x[i] from the start of side i to the foot of a star's arm; nothing without such a
/// star. Arm i has x[(i + 1) % N] edges, for N = 3 or 5 sides. One of five arms may have length 0: its foot
/// is the center, and the adjacent arms lie on its side.
std::optional<std::array<int, 5>> star_feet(std::span<const int> sides);

/// Returns the sides of a polygon without a grid of `along` edges at the start of side `at` and `back` edges
/// on the previous side. The new side comes first, then the rest of side `at`, and so on.
std::array<int, 5> sides_without_corner(std::span<const int> sides, int at, int along, int back);

/// Range of grids in a corner of a polygon that may leave a star; empty if a least number exceeds a most.
struct CornerGrids {
  int least_along = 1, least_back = 1, most_along = 0, most_back = 0;
};
/// Returns the range at the corner before side `at`, for two or four sides.
CornerGrids corner_grids(std::span<const int> sides, int at);

/// Calls `f(at, along, back, remaining sides, feet of their star)` for all such grids of a polygon of two or
/// four sides, until f returns true. Returns whether it did.
template <class F>
bool any_corner(std::span<const int> sides, F&& f) {
  const int n = static_cast<int>(sides.size());
  for (int at = 0; at < n; ++at) {
    const CornerGrids grids = corner_grids(sides, at);
    for (int along = grids.least_along; along <= grids.most_along; ++along)
      for (int back = grids.least_back; back <= grids.most_back; ++back) {
        const std::array<int, 5> all = sides_without_corner(sides, at, along, back);
        const auto rest = std::span(all).first(n + 1);
        if (const auto feet = star_feet(rest); feet && f(at, along, back, rest, *feet)) return true;
      }
  }
  return false;
}

/// Returns the least number of irregular vertices of patterns without cuts, for a convex polygon of two to
/// five sides; negative without a pattern.
int least_irregular_of(std::span<const int> sides);

}  // namespace delquad
