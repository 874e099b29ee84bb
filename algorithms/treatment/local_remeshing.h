// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "algorithms/treatment/treatment_moves.h"
#include "base/marks.h"
#include "smoothing/relocation/quad_relocation.h"

// This header remeshes around bad quads. The treatment uses it last.

namespace delquad {

/// Elements below this eta are poor. Moves for the valences may not add to their penalty, and any move that
/// lowers it is allowed.
inline constexpr double kPoorEta = 0.3;
/// A corner with at most this sine is flat, reflex or inverted: eta 0.
inline constexpr double kFlatSine = 1e-7;

/// Badness of shapes in a part of a mesh, for comparison before and after an edit.
class ShapePenalty {
 public:
  /// Both must outlive this object.
  ShapePenalty(const QuadTopology& mesh, const QuadRelocation& relocation)
      : mesh_(mesh), relocation_(relocation) {}

  /// Returns the penalty >= 0 of elements around the vertices; dead vertices are skipped. It sums up (lack of
  /// sine / wanted sine)^3 over corners, so one flat corner outweighs several poor ones. An element of eta 0
  /// adds more than any number of others.
  double around(std::span<const int> vertices);
  /// Returns the number of examined elements.
  long long looks() const { return looks_; }

 private:
  const QuadTopology& mesh_;
  const QuadRelocation& relocation_;
  Marks elements_met_;
  long long looks_ = 0;
};

/// The last resort for a bad quad (own method). It tries every edit of the quad and its neighbors, up to a
/// ring of new quads around the neighborhood. Each edit is followed by untangling of a few rings, and the
/// best one is kept. The work of all attempts together is linear in the size of the mesh, which a mesh of
/// only bad quads exhausts.
class LocalRemeshing {
 public:
  /// All must outlive this object.
  LocalRemeshing(QuadTopology& mesh, QuadRelocation& relocation, ShapePenalty& penalty);

  /// Returns whether the penalty around the quad fell by at least `least_relief` > 0. The edit is not
  /// committed; touched() has the vertices around it.
  bool improve(int quad, double least_relief);
  std::span<const int> touched() const { return region_; }
  /// Return, for the last improvement, the number of quads of its ring, or else its move, which may be none
  /// (`at` negative).
  int ring_quads() const { return ring_quads_; }
  const TreatmentMove& move() const { return move_; }

 private:
  /// A move, or a ring around quads if it has any.
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
  /// Keeps the best edit, or the first one with enough relief.
  bool try_all(double least_relief, bool first_will_do);

  QuadTopology& mesh_;
  QuadRelocation& relocation_;
  ShapePenalty& penalty_;
  long long settlements_;    ///< remaining elements around vertices that may be settled
  std::vector<int> region_;  ///< vertices whose elements may change
  std::vector<int> free_;
  std::vector<Edit> edits_;
  int ring_quads_ = 0;
  TreatmentMove move_;
};

}  // namespace delquad
