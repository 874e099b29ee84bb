#pragma once

#include "mesh/mesh.h"

namespace delquad {

/// Makes points with the same coordinates one point, then ends of open edges that are at most `tolerance`
/// apart (a length; 0: none). The first of them stays. Triangles may end with a repeated vertex, points
/// unused.
void weld(Mesh& mesh, double tolerance);

}  // namespace delquad
