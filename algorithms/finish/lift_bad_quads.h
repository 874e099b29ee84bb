// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <tuple>

#include "base/counters.h"
#include "geometry/patches/places_inside.h"
#include "smoothing/surface/surface_lift.h"

// This header has the last repairs of quads in space. The pipeline uses it after its stages.

namespace delquad {

/// Counts of lift_bad_quads().
struct LiftingSummary {
  int moved = 0;       ///< vertices
  int rings = 0;       ///< rings of quads inside quads that stayed inverted or folded
  int repaired = 0;    ///< edits of quads around bad ones
  long long cost = 0;  ///< tried places of vertices; a place on CAD counts ten times
  int stopped = 0;     ///< tag of the face with the worst quad if the limit of cost ended the work; else 0
};

template <>
struct Counters<LiftingSummary> {
  using S = LiftingSummary;
  static constexpr const char* step = "lift_bad_quads";
  static constexpr auto all =
      std::tuple{counter("moved", &S::moved), counter("rings", &S::rings), counter("mended", &S::repaired),
                 counter("cost", &S::cost), counter("stopped", &S::stopped)};
};

/// Counts of repair_failing_quads().
struct FailingRepairSummary {
  int moved = 0;   ///< vertices
  int edited = 0;  ///< edits of quads around failing ones
};

template <>
struct Counters<FailingRepairSummary> {
  using S = FailingRepairSummary;
  static constexpr const char* step = "failing_quads";
  static constexpr auto all = std::tuple{counter("moved", &S::moved), counter("edited", &S::edited)};
};

/// Repairs quads that are worse in space than in the plane of their patch (own method). First it lifts quads
/// that are poor in space (lift_worst_on_surface()). Then each inverted, folded or turned quad gets a ring of
/// quads inside. The ring is lifted and kept if fewer quads are bad. Last it tries to merge quads and to
/// rotate or open edges around bad or flat quads, one at a time, and keeps improvements. It stores the places
/// in space of all patches of quads.
LiftingSummary lift_bad_quads(const AllPatches& in);

/// Repairs quads of a sound mesh that fail: by moves (repair_failing_on_surface()), edits
/// (edit_failing()), and moves again. It does nothing if a quad is inverted, folded or turned away from the
/// model.
FailingRepairSummary repair_failing_quads(const AllPatches& in, const SpaceLimits& limits);

}  // namespace delquad
