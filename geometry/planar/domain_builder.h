// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "geometry/planar/check_lines.h"
#include "geometry/planar/face_regions.h"
#include "geometry/planar/planar_model.h"

// This header makes planar domains of lines. Curves, layers and given meshes use it.

namespace delquad {

/// Curves with special lines.
struct SpecialCurves {
  /// Whether each curve is a crack; empty: none. At a crack nodes are doubled, and the other side gets own
  /// lines, on a curve of the same name.
  std::vector<char> cracks = {};
  int dangling = -1;  ///< curve with edges at single points, which are removed at last; -1: none
  bool may_bound_nothing =
      false;  ///< whether lines may have no region on either side, see drop_stray_lines()
};

/// Returns the domain with a patch for each face that has a region (own method). A patch has a point for each
/// corner of its face. If the boundary meets itself, at lines with the patch on both sides or at nodes that
/// it passes twice, corners are moved apart. They move along their bisectors by kOpening of the lines there,
/// so that the outline is a polygon with holes. Throws InputError, with the curve, for a line without a
/// region on either side.
PlanarDomain build_domain(Mesh lines, const Arrangement& arrangement, FaceRegions regions,
                          const BoundaryNames& names, const SpecialCurves& special = {});

/// Removes the lines that no patch has, and their points.
void drop_stray_lines(PlanarDomain& domain);
/// Removes the nodes that are not `used` (by node), and renumbers the others everywhere in the domain.
void keep_nodes(PlanarDomain& domain, const std::vector<char>& used);

/// Length by which corners are moved apart, over the shortest line at the node: far above rounding, far below
/// any edge.
inline constexpr double kOpening = 1e-6;

}  // namespace delquad
