#pragma once

#include <span>

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

}  // namespace delquad
