#pragma once

#include <array>
#include <span>
#include <vector>

#include "algorithms/treatment/shape_penalty.h"
#include "algorithms/treatment/treatment_moves.h"
#include "smoothing/relocation/quad_relocation.h"

namespace delquad {

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
