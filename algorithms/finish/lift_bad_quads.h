#pragma once

#include <tuple>
#include <vector>

#include "base/counters.h"
#include "patches/places_inside.h"

namespace delquad {

/// What became of quads that were bad in space, at the end.
struct LiftingSummary {
  int moved = 0;       ///< vertices
  int rings = 0;       ///< of quads, put inside those that stayed inverted or folded
  int mended = 0;      ///< changes of the quads around those
  long long cost = 0;  ///< places of vertices that were tried, those on CAD ten times
  int stopped = 0;     ///< the tag of the face with the worst quad, where it may not cost more; 0: it ended
};

template <>
struct Counters<LiftingSummary> {
  using S = LiftingSummary;
  static constexpr const char* step = "lift_bad_quads";
  static constexpr auto all =
      std::tuple{counter("moved", &S::moved), counter("rings", &S::rings), counter("mended", &S::mended),
                 counter("cost", &S::cost), counter("stopped", &S::stopped)};
};

/// The work of repair_failing_quads().
struct FailingRepairSummary {
  int moved = 0;   ///< vertices
  int edited = 0;  ///< changes of the quads around those that failed
};

template <>
struct Counters<FailingRepairSummary> {
  using S = FailingRepairSummary;
  static constexpr const char* step = "failing_quads";
  static constexpr auto all = std::tuple{counter("moved", &S::moved), counter("edited", &S::edited)};
};

/// Quads of a surface may be worse in space than in the plane in which they were treated, and nodes on curves
/// may have to give way: lifts those that are poor in space, see lift_worst_on_surface(). What is inverted,
/// folded or turned away from the model then gets a ring of quads inside, which is lifted again and kept if
/// fewer are bad. Last, quads are merged, and edges turned or opened, around what is bad still or flat, one
/// at a time, and what helps is kept. Patches of quads hold their places in space afterwards. Returns what
/// was done.
LiftingSummary lift_bad_quads(const AllPatches& in);

/// Repairs the quads of a sound mesh that fail by `size`. Moves come first, see mend_failing_on_surface(),
/// then edits, see edit_failing(), and moves once more. Nothing happens if a quad is inverted, folded or
/// turned away from the model.
FailingRepairSummary repair_failing_quads(const AllPatches& in, const SizeField& size);

}  // namespace delquad
