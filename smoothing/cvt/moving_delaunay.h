#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "delquad/mesh.h"

namespace delquad {

/// Of a triangle's corner, the next one counterclockwise, and the one before.
inline constexpr std::array<int, 3> kNextCorner = {1, 2, 0}, kLastCorner = {2, 0, 1};

/// A constrained Delaunay triangulation whose inner points move, between fixed boundary points. It follows
/// the points by flips; only where a triangle would turn over is it made anew.
///
/// Where four points are cocircular up to rounding, either diagonal stays.
class MovingDelaunay {
 public:
  /// Any triangulation; becomes Delaunay. Throws InputError naming a triangle that is flat or inverted.
  explicit MovingDelaunay(TriPatch initial);

  const TriPatch& patch() const { return tri_; }
  int n_points() const { return static_cast<int>(tri_.points.size()); }
  int n_boundary() const { return tri_.n_boundary; }
  /// Of each point, the corners 3 t + k that lie there, counterclockwise: those of boundary points from one
  /// boundary edge to the other.
  std::span<const int> corners(int i) const { return {&stars_[star_[i].begin], star_[i].count}; }

  /// Moves all points that are not the boundary's. False where that is not possible: a point outside of the
  /// patch, on its boundary or on another point; the points are then somewhere on their way.
  bool move_to(std::span<const Vec2> inner);

  /// What the moves took so far.
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
    std::size_t begin = 0;  ///< in stars_, with room for kSpare corners more than when it was made
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

/// Calls visit(t, k) for the triangles t around point i, which have it as corner k: see corners().
template <class Visit>
void for_each_corner(const MovingDelaunay& d, int i, Visit visit) {
  for (const int corner : d.corners(i)) visit(corner / 3, corner % 3);
}

/// The inner points of a patch along a Hilbert curve, so that what is close in the plane is close in memory:
/// for each its index in the patch.
std::vector<int> spatial_order(const TriPatch& patch);

/// The patch with `order[k]` in the place of its k-th inner point, and its triangles in the order of their
/// points. Boundary points stay where they are.
TriPatch reordered(const TriPatch& patch, const std::vector<int>& order);

}  // namespace delquad
