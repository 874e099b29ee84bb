#pragma once

#include "mesher/stages.h"

namespace delquad {

/// Parts what two patches of a surface have in common besides the curves between them.
///
/// Where nodes are few, as on a small round curve between faces that bend the same way, both may have a
/// chord, an edge inside, between the same two nodes of their boundaries, or a chord beside an edge of a
/// curve: in space these are one edge, with three or four elements. All but one of them (all, beside an edge
/// of a curve) are parted: of triangles by a point in the middle, of quads by an opening, see
/// QuadTopology::open, and left where the quads beside do not allow it. Of two faces that are one quad each
/// on the same nodes, one gets a ring of quads. A node with one quad of each of two faces, which share two
/// sides then, gets a third by an opening, as readers take two sides in common for an error. Returns what was
/// done, without the time.
PartingSummary part_twins(const AllPatches& in);

}  // namespace delquad
