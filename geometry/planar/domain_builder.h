// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "geometry/planar/check_lines.h"
#include "geometry/planar/face_regions.h"
#include "geometry/planar/planar_model.h"

// This header makes planar domains of lines. Curves, layers and given meshes use it.

namespace delquad {

/// Curves that are more, or less, than others.
struct SpecialCurves {
  /// By curve, empty: none. There the domain comes apart: nodes are doubled, and the other side gets lines of
  /// its own, on a curve of the same name.
  std::vector<char> cracks = {};
  int dangling = -1;  ///< edges at single points, which are no lines in the end
  bool may_bound_nothing =
      false;  ///< lines without a region on either side are no error, see drop_stray_lines()
};

/// Makes one patch for each face that has a region. In a patch's plane a point stands for each corner of its
/// face. Where the boundary meets itself, at lines with the patch on both sides and at nodes that it passes
/// twice, these are moved apart. They go into their corners by kOpening of the lines there, so that the
/// outline is a polygon with holes. Throws InputError, naming it, for a line without a region on either side.
PlanarDomain build_domain(Mesh lines, const Arrangement& arrangement, FaceRegions regions,
                          const BoundaryNames& names, const SpecialCurves& special = {});

/// Takes out the lines that no patch has, and their points.
void drop_stray_lines(PlanarDomain& domain);
/// Takes out the nodes that are not used; all that has numbers of nodes gets new ones.
void keep_nodes(PlanarDomain& domain, const std::vector<char>& used);

/// Part of the shortest line at a node: far above rounding, far below any edge.
inline constexpr double kOpening = 1e-6;

}  // namespace delquad
