#pragma once

#include <array>
#include <span>
#include <vector>

#include "delquad/metrics.h"
#include "geometry/mesh/half_edges.h"

namespace delquad {

/// Two irregular vertices that end rows of quads together: one of too few quads with one of too many.
struct IrregularPair {
  int few, many;               ///< indices into Mesh::points
  int edges;                   ///< of the shortest path between them
  std::array<int, 2> burgers;  ///< rows that end, in either direction; the larger first
};

struct PairedVertices {
  int necessary = 0, beyond = 0;  ///< irregular vertices; one that lacks two quads counts twice
  std::vector<IrregularPair> pairs;
  int unpaired = 0;  ///< in patches: the necessary ones, and what no path leads to
};

/// Which irregular vertices of a mesh of quads are necessary, and pairs of all others, nearest first.
///
/// The charge of a vertex is the number of its quads that are missing: 4 - quads inside of a patch, on the
/// patch's boundary ideal_quads() - quads. Patches are those of OpenQuads. Every mesh of a patch has the same
/// sum of charges, 4 chi - sum over its boundary (2 - ideal): that many irregular vertices are necessary,
/// and of those on curves inside of the mesh 4 - the sum of their ideals. All other charges cancel in pairs.
///
/// Paths run along edges and through no irregular vertex; of several of the same number of edges the shortest
/// one counts. A pair at the offset (x, y) in the grid along it has the Burgers vector (|x + y|, |x - y|): so
/// many columns and rows more has one side of a loop of edges around both than the other.
/// Of pairs of equally many edges the shortest comes first. A vertex with two quads too many or too few is in
/// two pairs. The numbering of the mesh does not matter.
PairedVertices pair_irregular(const Mesh& mesh, std::span<const HalfEdge> sides);

}  // namespace delquad
