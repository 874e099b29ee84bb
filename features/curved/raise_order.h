// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

#include "delquad/mesh.h"
#include "features/curved/curved_geometry.h"

// This header gives meshes elements of a higher order. Curved meshes use it.

namespace delquad {

/// Gives a mesh of straight quads elements of a higher order, 2 to 4. Nodes on lines lie on their curve, at
/// equal lengths of it. Nodes on other sides and inside lie on the face, next to their places in the straight
/// element. A side opposite to a curved side, nearer to it than its length, bends with it, less with growing
/// distance. So quads of thin layers on a curved wall stay sound. Elements may still be inverted, see
/// untangle_curved(). Own method.
void raise_order(Mesh& mesh, int order, const ModelGeometry& geometry);

/// Puts the inner nodes of a quad on the face, by Coons' blending of its sides [coons1967].
void place_inside(Mesh& mesh, std::size_t quad, const ModelGeometry& geometry);

}  // namespace delquad
