#pragma once

#include <array>
#include <span>
#include <vector>

#include "algorithms/treatment/treatment_moves.h"
#include "base/marks.h"
#include "smoothing/relocation/quad_relocation.h"

namespace delquad {

/// Below this eta an element is poor: moves for the valences may not add to the penalty around, and any move
/// that takes from it is welcome.
inline constexpr double kPoorEta = 0.3;
/// A corner whose sine is at most this is flat, reflex or turned over: eta 0.
inline constexpr double kFlatSine = 1e-7;

/// How bad the shapes of a part of a mesh are, for comparison before and after an edit.
class ShapePenalty {
 public:
  /// Both outlive this object.
  ShapePenalty(const QuadTopology& mesh, const QuadRelocation& relocation)
      : mesh_(mesh), relocation_(relocation) {}

  /// Of the corners of the elements around the vertices (dead ones are skipped), the sum of (what the sine
  /// lacks, as a part of what is wanted)^3: one flat corner outweighs a handful that are merely poor. To this
  /// comes how their vertices crowd, see QuadRelocation::crowding(), up to 1. Each element of eta 0 counts as
  /// much as any number of others.
  double around(std::span<const int> vertices);
  /// Elements that it has looked at so far.
  long long looks() const { return looks_; }

 private:
  const QuadTopology& mesh_;
  const QuadRelocation& relocation_;
  Marks elements_met_;
  long long looks_ = 0;
};

/// The last resort for a bad quad: every edit of it and its neighbours is tried, up to a ring of new quads
/// around the neighbourhood, each followed by untangling of some rings around, and the best is kept. A mesh
/// of which all is bad cannot be helped so: all attempts together settle vertices with a number of elements
/// around that is linear in its size, and none helps after.
class LocalRemeshing {
 public:
  /// All outlive this object.
  LocalRemeshing(QuadTopology& mesh, QuadRelocation& relocation, ShapePenalty& penalty);

  /// Whether the penalty around the quad fell by at least `least_relief`. The edit is not committed;
  /// touched() holds the vertices around.
  bool improve(int quad, double least_relief);
  std::span<const int> touched() const { return region_; }
  /// Of the last improvement: quads of its ring; else its move, which may be none (`at` negative).
  int ring_quads() const { return ring_quads_; }
  const TreatmentMove& move() const { return move_; }

 private:
  /// Either a move or, if it has quads, a pillow.
  struct Edit {
    TreatmentMove move{TreatmentMove::kDoublet, -1};  ///< none
    std::vector<int> pillow;
  };
  void collect_region(int quad, int rings, int enough);
  std::vector<int> neighbours(std::span<const int> elements, bool across_corners) const;
  void add_moves(int element);
  void add_pillow(std::vector<int> quads);
  void list_near_edits(int quad);
  void list_far_edits(int quad);
  void perform(const Edit& edit);
  void settle();
  /// Keeps the best of the edits, or the first one that takes off enough.
  bool try_all(double least_relief, bool first_will_do);

  QuadTopology& mesh_;
  QuadRelocation& relocation_;
  ShapePenalty& penalty_;
  long long settlements_;    ///< elements around vertices that may still be settled
  std::vector<int> region_;  ///< all vertices whose elements may change
  std::vector<int> free_;
  std::vector<Edit> edits_;
  int ring_quads_ = 0;
  TreatmentMove move_;
};

}  // namespace delquad
