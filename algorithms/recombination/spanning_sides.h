#pragma once

#include "delquad/mesh.h"

namespace delquad {

/// Cuts every interior side that joins two boundary points at its middle: its two triangles become four.
/// Returns how many sides were cut; the new points come last. The number of triangles keeps its parity.
int split_spanning_sides(TriPatch& tri);

}  // namespace delquad
