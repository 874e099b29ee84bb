#pragma once

#include <vector>

#include "patches/prepared.h"

namespace delquad {

/// Puts the layers of a problem into its domain, and makes the background mesh of the rest. Sizes become less
/// beside edges that are much shorter than these, and warnings tell where layers had to be lower, and where
/// the rest of the mesh is far coarser than they are.
void put_layers(const MeshProblem& problem, PlanarDomain& domain, PreparedProblem& p);

/// Which quads of a mesh are of layers: in each region the first ones.
std::vector<char> quads_in_layers(const PreparedProblem& prepared, const Mesh& mesh);

}  // namespace delquad
