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

/// Finds the necessary irregular vertices of a mesh of quads, and pairs the others, nearest first. Own
/// method.
PairedVertices pair_irregular(const Mesh& mesh, std::span<const HalfEdge> sides);

}  // namespace delquad
