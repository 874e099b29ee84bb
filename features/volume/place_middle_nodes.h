// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "delquad/mesh.h"

// This header gives edges of tetrahedra the middle nodes of a curved skin. Volume meshes use it.

namespace delquad {

/// Fills Mesh::middle_nodes of tetrahedra from the nodes of quads of order 2: middle nodes of sides lie on
/// sides, middle nodes of quads on diagonals. `number` has the point of the tetrahedra for each corner of the
/// skin; their triangles are the halves of its quads, in order. Where a Jacobian is not proven to keep a part
/// of the straight tetrahedron's, nodes move towards straight edges; `notes`, which may be null, tell where.
void place_middle_nodes(Mesh& cells, const Mesh& skin, const std::vector<int>& number, ReadNotes* notes);

}  // namespace delquad
