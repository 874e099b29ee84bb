#pragma once

#include <vector>

#include "delquad/mesh.h"

namespace delquad {

struct IrregularVertex {
  int vertex;
  int valence;
  double size;  ///< mean of the sizes of the elements around it
};

/// Vertices inside the mesh (not on its free edges) whose valence is not `regular`, ascending. element_size:
/// by element, triangles first.
std::vector<IrregularVertex> irregular_vertices(const Mesh& mesh, int regular,
                                                const std::vector<double>& element_size);

}  // namespace delquad
