// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "geometry/patches/surface_curves.h"
#include "geometry/planar/check_lines.h"
#include "geometry/planar/curve_pieces.h"

// This header turns planar curves into curves of flat faces. The curves of planar models use it.

namespace delquad {

/// The curves of a planar model as curves of a surface whose faces are flat. Maps are the identity.
struct FlatCurves {
  Mesh fine;             ///< points at z = 0
  SurfaceCurves curves;  ///< chain i is piece i: its points are the nodes of the piece
};

/// Returns the curves of a planar model. `lines` has the edges of the pieces. True curves give the angles at
/// corners. Each face with a region has a patch, in the order of faces.
FlatCurves flat_curves(const Mesh& lines, const Arrangement& arrangement, const FaceRegions& regions,
                       const BoundaryNames& names, const std::vector<CurvePiece>& pieces);

}  // namespace delquad
