// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "delquad/model.h"
#include "geometry/planar/arrangement.h"
#include "geometry/planar/check_lines.h"

// This header gives faces of an arrangement their regions. Planar domains and curves use it.

namespace delquad {

/// Regions of the faces of an arrangement.
struct FaceRegions {
  std::vector<int> region;      ///< region of each face, index into `regions`; -1: none
  std::vector<Entity> regions;  ///< in the order of their first faces
};

/// Names of each face; nothing if the face is unknown.
using FaceNames = std::vector<std::optional<std::vector<std::string>>>;

/// Returns the regions of lines without other information. A face is a region if it has names. It is also a
/// region if no region is around its component and no face of the component is known. Nameless regions are
/// called "domain", or "domain_1", "domain_2", ... if there are more.
FaceRegions regions_by_nesting(const Arrangement& arrangement, const FaceNames& names);

/// Returns the regions of loops. Each face belongs to the innermost loop around it. It has a region if this
/// loop has a name, or if no region is around the loop. The faces of a loop have one region. `loops_of_curve`
/// has the loops of each curve. Throws InputError for loops that overlap, holes outside of every region, and
/// named loops that others fill.
FaceRegions regions_of_loops(const Mesh& lines, const Arrangement& arrangement,
                             const std::vector<ModelLoop>& loops,
                             const std::vector<std::vector<int>>& loops_of_curve, const BoundaryNames& names);

}  // namespace delquad
