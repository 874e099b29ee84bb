// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "delquad/mesh.h"

// This header finds the boundary of a mesh. Readers and adaptation use it.

namespace delquad {

/// Returns whether triangles, or quads, have points of different z.
bool holds_surface(const Mesh& mesh);

/// Returns a mesh of lines alone: the lines of the mesh or, if it has none, the sides of single elements.
Mesh outline(const Mesh& mesh);

}  // namespace delquad
