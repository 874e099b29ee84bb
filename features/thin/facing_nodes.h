#pragma once

#include <functional>
#include <vector>

#include "geometry/planar/arrangement.h"
#include "geometry/planar/curve_pieces.h"
#include "geometry/planar/face_regions.h"
#include "geometry/planar/planar_model.h"

namespace delquad {

/// Lets nodes of curves face each other across regions that are thinner than about the size, so that whole
/// rows of quads fit into these. A node is where the phase of its curve, edges from its beginning, is a whole
/// number. Along strips between curves phases shall differ by whole numbers, of that parity which leaves even
/// numbers of edges on both sides of a line across, and edges shall be as long as the size: least squares,
/// piece by piece from the longest on, then in a few sweeps. Divided pieces, and those that have images or
/// are such, stay as they are.
///
/// `arrangement`: of the pieces with the numbers of edges that they have. `number`: gives pieces numbers of
/// edges that are even around regions, nearest to those wanted; the first time nothing is.
void face_nodes(const Arrangement& arrangement, const FaceRegions& regions, std::vector<CurvePiece>& pieces,
                const std::function<void(const std::vector<double>& wanted)>& number);

/// Takes sharp corners out of patches that stages mesh, as far as they are narrower than half an edge and
/// nodes face each other: adds their quads to domain.boundary, see cap_corners(). Nodes of these quads stay.
void cut_wedges(PlanarDomain& domain);

}  // namespace delquad
