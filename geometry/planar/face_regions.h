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

/// Which region each face of an arrangement has.
struct FaceRegions {
  std::vector<int> region;      ///< of each face: index into `regions`, -1: none
  std::vector<Entity> regions;  ///< in the order of their first faces
};

/// Names of each face, where something is known of it.
using FaceNames = std::vector<std::optional<std::vector<std::string>>>;

/// Returns the regions of lines without other information. A face is a region if it has names. It is also one
/// if there is no region around the part that it belongs to and nothing is known of the faces beside it.
/// Nameless regions are called "domain", or "domain_1", "domain_2", ... if there are more.
FaceRegions regions_by_nesting(const Arrangement& arrangement, const FaceNames& names);

/// Regions of loops. Each face belongs to the innermost loop around it. It has a region if that loop has a
/// name, or if there is none around the loop. The faces of a loop have one region. `loops_of_curve`: of each
/// curve of the lines. Throws InputError for loops that overlap, holes outside of every region, and named
/// loops that others fill.
FaceRegions regions_of_loops(const Mesh& lines, const Arrangement& arrangement,
                             const std::vector<ModelLoop>& loops,
                             const std::vector<std::vector<int>>& loops_of_curve, const BoundaryNames& names);

}  // namespace delquad
