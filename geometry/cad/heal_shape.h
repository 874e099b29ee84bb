#pragma once

#include "geometry/cad/cad_shape.h"

namespace delquad::cad {

/// Repairs what the kernel finds invalid, and sews free edges that coincide within `tolerance` (a length), of
/// however many faces; valid shapes stay as they are. Says in the warnings what was done and what remains
/// wrong.
void heal_shape(CadShape& cad, double tolerance);

}  // namespace delquad::cad
