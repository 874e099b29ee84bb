// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "delquad/mesh.h"

// This header fills a skin of quads with hexahedra as far as they go. The filling of volumes begins with it.

namespace delquad {

/// Adds points and hexahedra inside of a closed skin; `volume` has its points and quads, counterclockwise
/// seen from outside. Two cells share nothing, a vertex, an edge or a side, and do not overlap; none crosses
/// the skin. Pyramids and tetrahedra can fill the rest. The points of the skin keep their places. `strategy`
/// is as check_strategy() wants it.
void place_hexahedra(Mesh& volume, const std::string& strategy);

}  // namespace delquad
