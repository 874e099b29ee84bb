#pragma once

#include <vector>

#include "geometry/cad/cad_shape.h"

namespace delquad::cad {

/// Repairs what the kernel finds invalid, and sews free edges that coincide within `tolerance` (a length), of
/// however many faces, but not those of faces that lie on each other; valid shapes stay as they are. Says in
/// the warnings what was done and what remains wrong.
void heal_shape(CadShape& cad, double tolerance);

/// Takes out those of some faces (numbers) whose edges lie on each other within their and their ends'
/// tolerances, and sews these edges; says so in a warning. False: none does, or that leaves free edges.
bool drop_strips(CadShape& cad, const std::vector<int>& faces);

}  // namespace delquad::cad
