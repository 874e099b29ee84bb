// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "delquad/mesh.h"

// This header finds the boundary of a mesh. Readers and adaptation use it.

namespace delquad {

/// Returns whether some triangle or quad does not lie in the plane of constant z of the first.
bool holds_surface(const Mesh& mesh);

/// Returns the boundary of a mesh as lines alone: its own lines, or the sides of one element only when it has
/// none.
Mesh outline(const Mesh& mesh);

}  // namespace delquad
