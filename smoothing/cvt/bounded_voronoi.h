// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "smoothing/cvt/moving_delaunay.h"

// This header has the Voronoi diagram of a patch. Lp-CVT uses it.

namespace delquad {

/// Bounded Voronoi diagram of a triangulation's points, boundary points included, in the parameter plane. The
/// cell of a seed is the part of the patch that sees it and sees no nearer seed. It is dual to the
/// constrained Delaunay triangulation [tournois2010]. Inside the patch the circumcenter of a triangle is a
/// corner of three cells. If it lies beyond a boundary edge, the triangle is blind, and the edges between
/// cells end on that boundary edge.
///
/// Since all boundary points are seeds, no cell reaches around a corner of the boundary, and the diagram is
/// continuous in the seeds.
class BoundedVoronoi {
 public:
  /// Point where the edge between two cells meets the boundary.
  struct Clip {
    int side;        ///< side 3 t + k of a blind triangle that is dual to the edge
    int from, to;    ///< ends of the side, which are the two seeds
    Vec2 at;         ///< on the boundary edge
    Vec2 direction;  ///< unit vector along the boundary edge
  };
  /// Part of a boundary edge in the cell of a seed that is no end of the edge.
  struct Piece {
    int seed;
    int from, to;  ///< clips, in the direction of the boundary edge
  };
  static constexpr int kOutside = -1;  ///< in place of a clip: the edge lies outside the patch

  /// Builds the diagram. Returns false if floating point cannot tell it (three points on a line along the
  /// boundary).
  bool build(const MovingDelaunay& delaunay);

  /// Returns the circumcenter of each triangle.
  const std::vector<Vec2>& centres() const { return centres_; }
  /// Returns whether the cell of a seed has corners other than circumcenters, or is at the boundary.
  bool is_cut(int seed) const { return cut_[seed] != 0; }
  /// Returns whether the circumcenter of a triangle lies beyond a boundary edge.
  bool is_blind(int triangle) const { return blind_[triangle] >= 0; }
  /// Returns where the edge dual to side k of a blind triangle ends: a clip or kOutside.
  int clip_of(int triangle, int k) const { return clip_of_[blind_[triangle]][k]; }
  const std::vector<Clip>& clips() const { return clips_; }
  const std::vector<Piece>& pieces() const { return pieces_; }

 private:
  struct Chain;
  bool grow(const TriPatch& tri, int triangle, int entered, Chain& chain);

  std::vector<Vec2> centres_;
  std::vector<int> blind_;  ///< index into clip_of_ for each triangle; -1: not blind
  std::vector<char> cut_;   ///< by point
  std::vector<std::array<int, 3>> clip_of_;
  std::vector<Clip> clips_;
  std::vector<Piece> pieces_;
};

}  // namespace delquad
