#pragma once

#include <memory>

#include "features/curved/model_geometry.h"
#include "patches/prepared.h"

namespace delquad {

/// The true model behind a mesh that was made of a problem: curves and formulas, CAD or triangles. `nodes`:
/// where the nodes on curves came to lie. Lines that were given, and those of the mesh that are on no curve,
/// are straight. All arguments outlive it.
std::unique_ptr<ModelGeometry> geometry_behind(const PreparedProblem& prepared, const SurfaceNodes& nodes,
                                               const Mesh& mesh);

}  // namespace delquad
