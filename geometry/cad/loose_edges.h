#pragma once

#include <vector>

#include "geometry/cad/cad_shape.h"

namespace delquad::cad {

/// The edges that bound no face, those inside of faces and those beside all, as polylines no further than
/// `deflection` (a length) from them, and the vertices that no edge has. Edges without a curve and infinite
/// ones are left to others.
std::vector<LooseLine> loose_edges(const CadShape& cad, double deflection);

/// Takes edges and vertices inside of one face alone out of it: the kernel fails to triangulate some faces
/// with them.
void drop_inner_edges(CadShape& cad);

}  // namespace delquad::cad
