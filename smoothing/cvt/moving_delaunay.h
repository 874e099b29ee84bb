#pragma once

#include <array>
#include <span>
#include <vector>

#include "delquad/mesh.h"

namespace delquad {

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
  /// Of each point a corner 3 t + k of a triangle that has it: for boundary points, the first in
  /// counterclockwise order around the point.
  const std::vector<int>& first_corner() const { return first_corner_; }

  /// Moves all points that are not the boundary's. False where that is not possible: a point outside of the
  /// patch, on its boundary or on another point; the points are then somewhere on their way.
  bool move_to(std::span<const Vec2> inner);

  /// What the moves took so far.
  long long flips() const { return flips_; }
  int rebuilds() const { return rebuilds_; }

 private:
  bool follow(const std::vector<Vec2>& from, const std::vector<Vec2>& to, int halvings);
  bool all_upright() const;
  bool rebuild(const std::vector<Vec2>& points);
  void make_delaunay();
  bool illegal(int side) const;
  void flip(int side);
  void find_first_corners();

  TriPatch tri_;
  PatchBoundary boundary_;
  std::vector<int> first_corner_;
  std::vector<int> stack_;
  long long flips_ = 0;
  int rebuilds_ = 0;
};

/// Calls visit(t, k) for the triangles t around point i, counterclockwise, which have it as corner k; for
/// boundary points from one boundary edge to the other.
template <class Visit>
void for_each_corner(const MovingDelaunay& d, int i, Visit visit) {
  constexpr int kNext[] = {1, 2, 0};
  const TriPatch& tri = d.patch();
  int t = d.first_corner()[i] / 3;
  const int first = t;
  do {
    int k = 0;
    while (tri.triangles[t][k] != i) ++k;
    visit(t, k);
    t = tri.neighbours[t][kNext[k]];
  } while (t >= 0 && t != first);
}

}  // namespace delquad
