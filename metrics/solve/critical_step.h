#pragma once

#include "delquad/mesh.h"

namespace delquad {

/// The largest stable step of central differences for waves of speed 1 in a membrane that the mesh is: 2 over
/// the largest frequency [hughes2000, section 9.1], with bilinear quads and linear triangles by 2 x 2 Gauss
/// points, quads projected to their middle planes, and masses lumped by rows. By Lanczos' method, to half of
/// kEigenvalueTolerance. A mesh of squares has their side. 0 where an element is inverted or flat at a point,
/// not a number where the method does not converge.
double critical_step(const Mesh& mesh);

}  // namespace delquad
