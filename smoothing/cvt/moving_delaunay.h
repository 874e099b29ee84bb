// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "delquad/mesh.h"

// This header has a triangulation that follows moving points. Lp-CVT uses it.

namespace delquad {

/// Next and previous corner of a triangle, counterclockwise.
inline constexpr std::array<int, 3> kNextCorner = {1, 2, 0}, kLastCorner = {2, 0, 1};

/// Constrained Delaunay triangulation whose inner points move between fixed boundary points, in the parameter
/// plane. It follows the points by flips, and is rebuilt only if a triangle would be inverted.
///
/// If four points are cocircular up to rounding, either diagonal stays.
class MovingDelaunay {
 public:
  /// Takes any triangulation and makes it Delaunay. Throws InputError with a flat or inverted triangle.
  explicit MovingDelaunay(TriPatch initial);

  const TriPatch& patch() const { return tri_; }
  int n_points() const { return static_cast<int>(tri_.points.size()); }
  int n_boundary() const { return tri_.n_boundary; }
  /// Returns the corners 3 t + k at a point, counterclockwise; at boundary points from one boundary edge to
  /// the other.
  std::span<const int> corners(int i) const { return {&stars_[star_[i].begin], star_[i].count}; }

  /// Moves all inner points, in their order. Returns false if a point is outside the patch, on its boundary
  /// or on another point. Then the points are somewhere on their way.
  bool move_to(std::span<const Vec2> inner);

  /// Returns the work of the moves so far.
  long long flips() const { return flips_; }
  int rebuilds() const { return rebuilds_; }

 private:
  bool follow(const std::vector<Vec2>& from, const std::vector<Vec2>& to, int halvings);
  bool follow_in_halves(const std::vector<Vec2>& from, const std::vector<Vec2>& to, int halvings);
  bool all_upright() const;
  bool rebuild(const std::vector<Vec2>& points);
  void make_delaunay();
  bool illegal(int side) const;
  void find_illegal(std::size_t begin, std::size_t end, std::vector<int>& found) const;
  void flip(int side);
  void make_stars();
  bool renew_star(int i);

  TriPatch tri_;
  PatchBoundary boundary_;
  struct Star {
    std::size_t begin = 0;  ///< in stars_, with space for kSpare more corners than at first
    unsigned count = 0, room = 0;
    int first = -1;
    bool stale = false;
  };
  std::vector<Star> star_;
  std::vector<int> stars_, stale_;
  std::vector<Vec2> to_;
  std::vector<int> stack_;
  long long flips_ = 0;
  int rebuilds_ = 0;
};

/// Calls visit(t, k) for each triangle t around point i, whose corner k is i, see corners().
template <class Visit>
void for_each_corner(const MovingDelaunay& d, int i, Visit visit) {
  for (const int corner : d.corners(i)) visit(corner / 3, corner % 3);
}

/// Returns the indices of the inner points along a Hilbert curve, so that neighbors in the plane are close in
/// memory.
std::vector<int> spatial_order(const TriPatch& patch);

/// Returns the patch with `order[k]` as its k-th inner point, and triangles in the order of their points.
/// Boundary points keep their places.
TriPatch reordered(const TriPatch& patch, const std::vector<int>& order);

}  // namespace delquad
