// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "delquad/mesh.h"

// This header fills gaps between hexahedra with prisms. The filling of volumes does it before pyramids.

namespace delquad {

/// Adds a prism between each three quads of the skin or of hexahedra that enclose one, with a scaled Jacobian
/// of 0.2 at least. The triangles of prisms cross no other face (exact). `volume`: as from place_hexahedra().
/// Own method.
void place_prisms(Mesh& volume);

}  // namespace delquad
