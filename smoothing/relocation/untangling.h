// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>

#include "delquad/fields.h"
#include "geometry/mesh/quad_topology.h"

// This header untangles and lengthens by moves of vertices. Clean-up, treatment, grids and optimization use
// it.

namespace delquad {

/// Moves `vertices` (interior ones of quads) together, from any start, until every corner on them turns left.
/// Other vertices stay, and so do these if all corners turn left already. Returns whether all turn left. If
/// not, the places with the best least area are kept.
///
/// It lowers the sum over corners of (|a|^2 + |b|^2) / chi(a x b) vertex by vertex [escobar2003]. Here a and
/// b are the corner's sides, and chi(d) = (d + sqrt(d^2 + e^2)) / 2 is positive for all d. The value e falls
/// with the least a x b.
bool untangle(QuadTopology& mesh, std::span<const int> vertices);

/// Returns whether an edge is shorter than 1e-3 delta', so that lengthen_short_edges() might move a vertex.
bool may_have_short_edges(const QuadPatch& mesh, const ParametricSize& size);

/// Lengthens edges shorter than 1e-3 delta' (own method). Their directions are noise, and so are the angles
/// beside them, so relocation cannot help. An interior end moves towards the middle of its neighbors, to the
/// largest least sine around. Returns the number of moved vertices.
int lengthen_short_edges(QuadTopology& mesh, const ParametricSize& size);

}  // namespace delquad
