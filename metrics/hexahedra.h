#pragma once

#include <array>
#include <vector>

#include "delquad/hexahedra.h"

namespace delquad {

using HexCorners = std::array<Vec3, 8>;

inline HexCorners corners_of(const std::vector<Vec3>& points, const std::array<int, 8>& hexahedron) {
  HexCorners at;
  for (int k = 0; k < 8; ++k) at[k] = points[hexahedron[k]];
  return at;
}

/// The determinant of the unit vectors along the edges at a corner, the least of eight.
double scaled_jacobian(const HexCorners& at);

/// Of the trilinear hexahedron, positive where its corners are in order.
double signed_volume(const HexCorners& at);

/// Part of the product of three edges' lengths below which a Jacobian counts as zero: far more than what
/// rounding of coordinates leaves of flat hexahedra, far less than what solvers take.
inline constexpr double kLeastHexJacobian = 1e-9;

/// Whether the Jacobian of the trilinear map is positive everywhere in the hexahedron, by its Bernstein
/// coefficients, also those of its parts. False where that is not found out.
bool is_positive(const HexCorners& at);

}  // namespace delquad
