#pragma once

#include "delquad/fields.h"
#include "geometry/mesh/quad_topology.h"

namespace delquad {

/// False: lengthen_short_edges() would move nothing.
bool may_have_short_edges(const QuadPatch& mesh, const ParametricSize& size);

/// Parts the ends of edges shorter than 1e-3 delta', whose directions and with them the angles of the quads
/// beside mean nothing, so that no relocation by angles can lengthen them: an interior end goes towards the
/// middle of its neighbours, as far as the least sine around is largest. Returns how many vertices moved.
int lengthen_short_edges(QuadTopology& mesh, const ParametricSize& size);

}  // namespace delquad
