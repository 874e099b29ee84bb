#pragma once

#include "geometry/cad/cad_shape.h"

namespace delquad::cad {

/// The kernel's reader of STEP turns some faces with a pole inside over, and moves their edges by a period in
/// (u, v) until they fit: the face then is the other part of the sphere and more, going around more than
/// once. Such faces are turned back, where that makes them fit into a period; a warning tells how many.
void unwind_faces(CadShape& cad);

}  // namespace delquad::cad
