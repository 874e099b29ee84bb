#pragma once

#include <array>
#include <vector>

#include "geometry/surface/surface_model.h"

namespace delquad::cad {

/// Pairs of faces (indices of regions, ascending) of different bodies that lie on each other somewhere,
/// within `tolerance` (a length), without being one or sharing a side. `bodies`: faces of each. Places are
/// looked at triangle by triangle: faces that touch in less may be missed. `deflection`: how far triangles
/// may be off.
std::vector<std::array<int, 2>> touching_faces(const SurfaceModel& model,
                                               const std::vector<std::vector<int>>& bodies, double deflection,
                                               double tolerance);

}  // namespace delquad::cad
