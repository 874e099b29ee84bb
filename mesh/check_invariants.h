#pragma once

#include <string>
#include <vector>

#include "delquad/mesh.h"

namespace delquad {

/// check_invariants() of meshes of branching surfaces: on edges of the marked curves (by index) any number of
/// elements may meet.
std::vector<std::string> check_invariants(const Mesh& mesh, const std::vector<char>& branching);

}  // namespace delquad
