// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "algorithms/fields/background_mesh.h"
#include "algorithms/fields/fields.h"
#include "algorithms/fields/laplace.h"

// This header finds the singularities of a cross field. Cross fields use it.

namespace delquad {

/// Winding of a field around the cells of a patch, in whole turns of 4 theta. The middles of the sides cut it
/// into one cell for each triangle and one for each vertex. Between two middles of one triangle, the phase 4
/// theta turns by less than half a turn more or less than expected. So it winds a whole number of times
/// around each cell: the cell's index. At a vertex on the boundary, the turn of the corner is compared with
/// the turn of the field.
struct FieldWinding {
  std::vector<int> of_triangle;
  /// For each vertex the turns of the phase. They are whole numbers, up to rounding, if the field on the
  /// boundary lies along it.
  std::vector<double> of_vertex;
  std::vector<char> is_inside;  ///< whether a vertex lies inside
};

/// Returns the winding of a field with these crosses on sides. `expected` has the expected turn of the phase
/// (radians) from each triangle's centroid to the middles of its sides; empty: none.
FieldWinding find_winding(const BackgroundMesh& background, const Sides& sides,
                          const std::vector<Cross>& crosses,
                          const std::vector<std::array<double, 3>>& expected = {});

/// Vertices of patches that are one point of a surface.
struct JoinedVertices {
  std::vector<std::array<int, 2>> vertices;  ///< patch and vertex
  int n_shared = 0;                          ///< sides that begin or end there and join two of them
};
/// Adds up the winding around joined vertices in vertices[0], and clears it at the others. vertices[0] is
/// inside if all its sides are shared.
void join_windings(const std::vector<JoinedVertices>& joined, std::vector<FieldWinding>& windings);

/// Returns the sum of all indices of a patch, and the list of singularities inside. Opposite indices of cells
/// that touch are noise; they are not listed and do not change the sum.
FieldTopology find_singularities(const BackgroundMesh& background, const Sides& sides,
                                 const std::vector<Cross>& crosses, const FieldWinding& winding);

}  // namespace delquad
