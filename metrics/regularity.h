// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <span>
#include <vector>

#include "delquad/metrics.h"
#include "geometry/mesh/half_edges.h"

// This header pairs irregular vertices. The measures of a mesh use it.

namespace delquad {

/// Two irregular vertices that end rows of quads together: one with too few quads, one with too many.
struct IrregularPair {
  int few, many;               ///< indices into Mesh::points
  int edges;                   ///< number of edges on the shortest path between them
  std::array<int, 2> burgers;  ///< ending rows in either direction; the larger first
};

struct PairedVertices {
  int necessary = 0, beyond = 0;  ///< irregular vertices; a vertex that lacks two quads counts twice
  std::vector<IrregularPair> pairs;
  int unpaired = 0;  ///< in patches: necessary vertices, and vertices that no path reaches
};

/// Finds the necessary irregular vertices of a mesh of quads, and pairs the others, nearest first.
///
/// The charge of a vertex is its number of missing quads. It is 4 - quads inside a patch, and ideal_quads() -
/// quads on its boundary. Patches are as in OpenQuads. Every mesh of a patch has the same sum of charges, 4
/// chi - sum over its boundary (2 - ideal). It is the number of necessary irregular vertices. On inner
/// curves, 4 - the sum of the ideals is necessary. All other charges cancel in pairs.
///
/// Paths run along edges and pass no irregular vertex. Among paths with equally many edges the shortest
/// counts. A pair at the grid offset (x, y) has the Burgers vector (|x + y|, |x - y|). It is the difference
/// of columns and rows on a loop around it. Among pairs with equally many edges the shortest comes first. A
/// vertex with two missing or extra quads is in two pairs. Numbering of the mesh does not matter.
PairedVertices pair_irregular(const Mesh& mesh, std::span<const HalfEdge> sides);

}  // namespace delquad
