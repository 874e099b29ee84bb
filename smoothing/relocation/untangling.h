#pragma once

#include <span>

#include "delquad/fields.h"
#include "geometry/mesh/quad_topology.h"

namespace delquad {

/// Moves `vertices` (interior ones of quads) together so that every corner on them turns left, from
/// any start. All others stay where they are, and so do these when all turns left already. Returns whether
/// that is reached; if not, the places are the best ones found, by the least area.
///
/// Lowers the sum over the corners of (|a|^2 + |b|^2) / chi(a x b) vertex by vertex, where a and b are the
/// corner's sides and chi(d) = (d + sqrt(d^2 + e^2)) / 2 stays positive where d is not; e falls with the
/// least a x b (Escobar et al. 2003).
bool untangle(QuadTopology& mesh, std::span<const int> vertices);

/// False: lengthen_short_edges() would move nothing.
bool may_have_short_edges(const QuadPatch& mesh, const ParametricSize& size);

/// Parts the ends of edges shorter than 1e-3 delta', whose directions and with them the angles of the quads
/// beside mean nothing, so that no relocation by angles can lengthen them: an interior end goes towards the
/// middle of its neighbours, as far as the least sine around is largest. Returns how many vertices moved.
int lengthen_short_edges(QuadTopology& mesh, const ParametricSize& size);

}  // namespace delquad
