// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "delquad/mesh.h"

// This header fills the space that hexahedra and prisms leave in a body. Volume meshes use it.

namespace delquad {

/// Adds pyramids and tetrahedra to a body. Its quads and triangles are the closed skin and look outwards; its
/// hexahedra and prisms lie inside and may use quads as faces. They go where the filling fails, and
/// move or are divided where it has poor cells. Without `improve` cells stay as made, at any positive
/// quality. All cells are of volume 0. Returns the faces of the skin, quads first, at which the filling
/// fails; empty: the body is full.
std::vector<int> fill_around(Mesh& body, bool improve = true);

}  // namespace delquad
