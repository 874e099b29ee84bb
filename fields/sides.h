#pragma once

#include <array>
#include <vector>

#include "delquad/mesh.h"

namespace delquad {

/// A number for each side of a triangulation, in the order of the triangles.
struct Sides {
  std::vector<std::array<int, 3>> of_triangle;  ///< the side opposite to each vertex
  int count = 0;
};
Sides number_sides(const TriPatch& tri);

}  // namespace delquad
