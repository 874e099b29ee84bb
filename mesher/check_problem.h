#pragma once

#include <string>

#include "delquad/mesher.h"

namespace delquad {

/// Throws InputError, saying what is wrong and where, for a problem that makes no sense, whatever its model
/// is found to be: meshes that cannot be read (see require_readable()), models with nothing in them, numbers
/// out of range, and things that contradict each other.
void check_problem(const MeshProblem& problem);

}  // namespace delquad
