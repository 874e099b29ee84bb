#pragma once

#include "geometry/planar/boundary_loops.h"
#include "geometry/planar/planar_model.h"

namespace delquad {

/// make_domain() with names of the caller's choice in the messages.
PlanarDomain build_domain(Mesh lines, const std::vector<std::pair<int, std::string>>& loop_regions,
                          const BoundaryNames& names);

}  // namespace delquad
