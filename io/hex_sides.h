#pragma once

#include <array>
#include <vector>

#include "delquad/mesh.h"

namespace delquad {

/// A side of a hexahedron by its four nodes in order.
struct HexSide {
  std::array<int, 4> nodes;
  int hexahedron, side;  ///< `side`: 1 to 6, as S1 to S6 of Abaqus's C3D8
};
std::vector<HexSide> sorted_hex_sides(const Mesh& mesh);
/// The sides on a quad of the mesh: one on the boundary, else two.
std::vector<HexSide> sides_at_quad(const Mesh& mesh, const std::vector<HexSide>& sorted, int quad);

}  // namespace delquad
