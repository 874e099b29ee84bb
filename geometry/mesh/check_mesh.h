#pragma once

#include <string>

#include "delquad/mesh.h"

namespace delquad {

/// Throws InputError, which begins with `where`, for what no function that takes a mesh can do with: indices
/// out of range, lists of different lengths, coordinates that are not finite. What is wrong with a mesh
/// otherwise, see check_invariants().
void require_readable(const Mesh& mesh, const std::string& where);

/// Throws InputError, which begins with `where`, for elements of a higher order.
void require_straight(const Mesh& mesh, const std::string& where);

}  // namespace delquad
