#pragma once

#include "delquad/mesh.h"
#include "features/curved/model_geometry.h"

namespace delquad {

/// Puts a ring of quads into each quad that has a corner on a smooth curve, or one hardly less than flat: a
/// curved one would have no area there. Every corner then has two quads. Returns how many got one. The
/// elements must have order 1.
int part_flat_corners(Mesh& straight, const ModelGeometry& geometry);

}  // namespace delquad
