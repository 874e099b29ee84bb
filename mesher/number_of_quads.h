#pragma once

#include <functional>
#include <utility>

#include "delquad/mesher.h"
#include "patches/prepared.h"

// Meshes of about as many quads as are asked for (MeshProblem::quads), by other sizes.

namespace delquad {

/// The problem, whose files are read, by sizes at which as many quads are expected; these are its own then.
/// Where it has none, the size is the same everywhere. Throws InputError for numbers that cannot be.
PreparedProblem prepare_for_quads(MeshProblem& problem);

/// Meshes a problem, whose files are read.
using MeshAnew = std::function<std::pair<Prepared, MeshResult>(MeshProblem problem)>;
/// Meshes anew by other sizes, twice at most, until there are as many quads as are asked for to 3 %. Both
/// become those of the nearest mesh, sound ones first, with the time of all; a warning tells where that is
/// not near enough.
void meet_quads(const MeshAnew& mesh_anew, Prepared& prepared, MeshResult& result);

}  // namespace delquad
