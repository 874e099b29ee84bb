#pragma once

#include <array>
#include <vector>

#include "smoothing/cvt/moving_delaunay.h"

namespace delquad {

/// The bounded Voronoi diagram of a triangulation's points, boundary points included: the cell of a seed is
/// what it sees of the patch and no other visible seed is nearer to. Dual to the constrained Delaunay
/// triangulation [tournois2010]: inside of the patch a triangle stands for the corner of three cells at its
/// circumcentre; where that lies beyond a boundary edge, the triangle is blind, and the edges between cells
/// end on that boundary edge instead.
///
/// All boundary points being seeds, no cell reaches around a corner of the boundary, and the diagram is
/// continuous in the seeds.
class BoundedVoronoi {
 public:
  /// Where the edge between two cells meets the boundary.
  struct Clip {
    int side;        ///< 3 t + k, of a blind triangle: the edge that is dual to it
    int from, to;    ///< that side's ends, the two seeds
    Vec2 at;         ///< on the boundary edge
    Vec2 direction;  ///< of that boundary edge, unit length
  };
  /// A part of a boundary edge that belongs to the cell of a seed which is neither of its ends.
  struct Piece {
    int seed;
    int from, to;  ///< clips, in the direction of the boundary edge
  };
  static constexpr int kOutside = -1;  ///< instead of a clip: the edge lies outside of the patch

  /// False where the points lie so that no diagram can be told in floating point (three on a line along the
  /// boundary).
  bool build(const MovingDelaunay& delaunay);

  /// Circumcentre of each triangle.
  const std::vector<Vec2>& centres() const { return centres_; }
  /// Whether the cell of a seed has other corners than the circumcentres around the seed.
  bool is_cut(int seed) const { return cut_[seed] != 0; }
  bool is_blind(int triangle) const { return blind_[triangle] >= 0; }
  /// Of a blind triangle, where the edge dual to its side k ends: a clip or kOutside.
  int clip_of(int triangle, int k) const { return clip_of_[blind_[triangle]][k]; }
  const std::vector<Clip>& clips() const { return clips_; }
  const std::vector<Piece>& pieces() const { return pieces_; }

 private:
  struct Chain;
  bool grow(const TriPatch& tri, int triangle, int entered, Chain& chain);

  std::vector<Vec2> centres_;
  std::vector<int> blind_;  ///< of each triangle: index into clip_of_, -1: not blind
  std::vector<char> cut_;   ///< of each point
  std::vector<std::array<int, 3>> clip_of_;
  std::vector<Clip> clips_;
  std::vector<Piece> pieces_;
};

}  // namespace delquad
