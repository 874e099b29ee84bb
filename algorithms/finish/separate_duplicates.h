// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <tuple>

#include "base/counters.h"
#include "geometry/patches/places_inside.h"

// This header removes duplicate edges and quads between patches. The pipeline uses it before its repairs.

namespace delquad {

/// Counts of separate_duplicates() over all stages.
struct SeparationSummary {
  int chords = 0;        ///< chords that were split
  int left = 0;          ///< chords that could not be opened
  int rings = 0;         ///< rings of quads inside faces of one quad
  int corners = 0;       ///< nodes with only two quads, where one face got a second quad
  int corners_left = 0;  ///< such nodes where opening would leave bad quads
};

template <>
struct Counters<SeparationSummary> {
  using S = SeparationSummary;
  static constexpr const char* step = "part_twins";
  static constexpr auto all =
      std::tuple(counter("chords", &S::chords), counter("left", &S::left), counter("rings", &S::rings),
                 counter("corners", &S::corners), counter("corners_left", &S::corners_left));
};

/// Removes edges and quads that two patches of a surface share besides their common curves (own method).
/// Returns the counts of its edits.
///
/// If nodes are few, as on a small round curve, both patches may have a chord (an inner edge) between the
/// same two boundary nodes. A chord may also lie beside an edge of a curve. Such chords are one edge in
/// space, with three or four elements. All but one are split, or all beside an edge of a curve: triangles by
/// a midpoint, quads by QuadTopology::open if possible. If two faces are one quad each on the same nodes, one
/// gets a ring of quads. A node with one quad in each of two faces gets a third quad by an opening, since
/// readers refuse two common sides.
SeparationSummary separate_duplicates(const AllPatches& in);

}  // namespace delquad
