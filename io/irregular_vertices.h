#pragma once

#include <array>
#include <vector>

#include "delquad/mesh.h"

namespace delquad {

struct IrregularVertex {
  int vertex;
  int valence;  ///< on the boundary, where it is that of a pair, as inside: 3 or 5
  double size;  ///< mean of the sizes of the elements around it
};

/// What pictures show.
struct IrregularVertices {
  std::vector<IrregularVertex> vertices;  ///< ascending
  std::vector<std::array<int, 2>> pairs;  ///< of a mesh of quads, see pair_irregular()
};

/// Vertices inside the mesh (not on its free edges) whose valence is not `regular`, and those of pairs.
/// element_size: by element, triangles first.
IrregularVertices irregular_vertices(const Mesh& mesh, int regular, const std::vector<double>& element_size);

}  // namespace delquad
