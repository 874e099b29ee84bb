#pragma once

#include <tuple>

#include "base/counters.h"
#include "patches/places_inside.h"

namespace delquad {

/// What part_twins() did, over all stages.
struct PartingSummary {
  int chords = 0;        ///< parted
  int left = 0;          ///< chords that the quads beside did not allow to part
  int rings = 0;         ///< of quads, put inside of faces of one quad
  int corners = 0;       ///< nodes with two quads in all, of which one face got a second one
  int corners_left = 0;  ///< those where that would have left bad quads
};

template <>
struct Counters<PartingSummary> {
  using S = PartingSummary;
  static constexpr const char* step = "part_twins";
  static constexpr auto all =
      std::tuple(counter("chords", &S::chords), counter("left", &S::left), counter("rings", &S::rings),
                 counter("corners", &S::corners), counter("corners_left", &S::corners_left));
};

/// Parts what two patches of a surface have in common besides the curves between them.
///
/// Where nodes are few, as on a small round curve between faces that bend the same way, both may have a
/// chord, an edge inside, between the same two nodes of their boundaries, or a chord beside an edge of a
/// curve: in space these are one edge, with three or four elements. All but one of them (all, beside an edge
/// of a curve) are parted: of triangles by a point in the middle, of quads by an opening, see
/// QuadTopology::open, and left where the quads beside do not allow it. Of two faces that are one quad each
/// on the same nodes, one gets a ring of quads. A node with one quad of each of two faces, which share two
/// sides then, gets a third by an opening, as readers take two sides in common for an error. Returns what was
/// done.
PartingSummary part_twins(const AllPatches& in);

}  // namespace delquad
