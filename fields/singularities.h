#pragma once

#include <array>
#include <vector>

#include "fields/background_mesh.h"
#include "fields/fields.h"
#include "fields/sides.h"

namespace delquad {

/// sides[t][k] numbers the side of triangle t opposite to vertex k, crosses[side] is the field there, which
/// on the boundary lies along it.
///
/// `expected` may say by how much the phase 4 theta is expected to turn from a triangle's centroid to the
/// middles of its sides; empty: not at all.
///
/// The middles of the sides cut the domain into one cell a triangle and one a vertex. The phase 4 theta is
/// taken to turn by less than half a turn more or less than expected between two middles of one triangle, so
/// that it winds a whole number of times around each cell: the cell's index. At a vertex on the boundary it
/// is the corner's turn that is compared with the field's. Opposite indices of cells that touch are noise and
/// not listed; they do not change the sum.
FieldTopology find_singularities(const BackgroundMesh& background, const Sides& sides,
                                 const std::vector<Cross>& crosses,
                                 const std::vector<std::array<double, 3>>& expected = {});

}  // namespace delquad
