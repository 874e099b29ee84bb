#pragma once

#include <vector>

#include "delquad/adapt.h"

namespace delquad {

/// The integral of sqrt(det M), by the values at points.
double complexity_of(const Mesh& mesh, const std::vector<Tensor2>& metric);

/// model_of_mesh() whose names are indices into lists of the mesh: of curves (one more: sides that have no
/// line), regions and named points.
PlanarModel trace_mesh(const Mesh& mesh);

}  // namespace delquad
