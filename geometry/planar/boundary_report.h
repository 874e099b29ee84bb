#pragma once

#include <string>
#include <vector>

#include "geometry/planar/planar_model.h"

namespace delquad {

/// One line for each patch whose boundary has an odd number of edges, which leaves a triangle when triangles
/// are merged to quads: names the region, its odd loops and their curves.
std::vector<std::string> odd_boundaries(const PlanarDomain& domain);

/// All edges of the patches' boundaries as lines of one curve, with the points of the domain.
Mesh edges_of_patches(const PlanarDomain& domain);

}  // namespace delquad
