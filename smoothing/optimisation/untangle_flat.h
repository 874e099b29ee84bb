#pragma once

#include "delquad/fields.h"
#include "delquad/mesh.h"

namespace delquad {

/// Opens edges without length and untangles what is inverted or flat, with its surroundings. Connectivity and
/// boundary points stay. Returns how many quads are no more so. Throws std::invalid_argument where there
/// are such and the input is not conforming.
int untangle_flat(QuadPatch& mesh, const ParametricSize& size);

}  // namespace delquad
