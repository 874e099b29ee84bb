#pragma once

#include <string>
#include <vector>

#include "base/warning.h"
#include "delquad/mesh.h"

namespace delquad {

/// Turns triangles so that neighbours agree, each component as most of its triangles run, closed ones
/// outwards; see repair_triangles. Where neighbours cannot agree, InputError, or, if they `may_part`, they
/// stay apart at sharp edges.
void orient_triangles(Mesh& mesh, const std::string& source, std::vector<Warning>& warnings,
                      bool may_part = false);

}  // namespace delquad
