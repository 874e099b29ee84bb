#pragma once

#include <string>
#include <vector>

#include "base/warning.h"
#include "delquad/mesh.h"

namespace delquad {

/// Turns triangles so that neighbours agree, each component as most of its triangles run, closed ones
/// outwards; see repair_triangles. Each edge must be in one or two triangles.
void orient_triangles(Mesh& mesh, const std::string& source, std::vector<Warning>& warnings);

}  // namespace delquad
