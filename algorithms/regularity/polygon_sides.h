#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

namespace delquad {

/// The edges of each side of a convex polygon, from `start`, the place of its first corner on the outline.
struct PolygonSides {
  std::vector<int> edges;
  int start = 0;
};

/// `turn`: as Outline has it. None where a vertex is concave or there are fewer than two corners.
std::optional<PolygonSides> sides_of(std::span<const int> turn);

/// The distances x[i] from the start of side i to the foot of a star's arm on that side; none where there is
/// no such star. Arm i has x[(i + 1) % N] edges. N, the number of sides, is 3 or 5. Of five arms one may have
/// none: its foot is the centre then, and the arms beside lie on its side.
std::optional<std::array<int, 5>> star_feet(std::span<const int> sides);

/// The sides of what is left of a polygon beside a grid of `along` edges on side `at`, at its start, and
/// `back` edges on the side before: first the new one, then what is left of side `at`, and on.
std::array<int, 5> sides_without_corner(std::span<const int> sides, int at, int along, int back);

/// Of the grids in a corner of a polygon of two or four sides that leave a star the least and the most edges.
struct CornerGrids {
  int least_along = 1, least_back = 1, most_along = 0, most_back = 0;
};
CornerGrids corner_grids(std::span<const int> sides, int at);

/// Calls f(at, along, back, sides of what is left, feet of its star) for all of them of a polygon of two or
/// four sides, until f returns true. Whether it did.
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

/// The least number of irregular vertices of a pattern of a convex polygon of two to five sides without cuts;
/// negative where there is none.
int least_irregular_of(std::span<const int> sides);

}  // namespace delquad
