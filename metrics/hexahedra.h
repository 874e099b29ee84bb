// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "delquad/hexahedra.h"

// This header measures hexahedra. Sweeps use it.

namespace delquad {

using HexCorners = std::array<Vec3, 8>;

inline HexCorners corners_of(const std::vector<Vec3>& points, const std::array<int, 8>& hexahedron) {
  HexCorners at;
  for (int k = 0; k < 8; ++k) at[k] = points[hexahedron[k]];
  return at;
}

/// Returns the least value of eight corners, in [-1, 1]: the determinant of unit vectors along the edges
/// there.
double scaled_jacobian(const HexCorners& at);

/// Returns the volume of the trilinear hexahedron, positive if its corners are in order.
double signed_volume(const HexCorners& at);

/// A Jacobian below this part of the product of three edge lengths counts as zero. It is far above rounding
/// of flat hexahedra, and far below the needs of solvers.
inline constexpr double kLeastHexJacobian = 1e-9;

/// Returns whether the Jacobian of the trilinear map is positive in the whole hexahedron, by Bernstein
/// coefficients of it and its parts, as in [johnen2013]. Returns false if that stays open.
bool is_positive(const HexCorners& at);

}  // namespace delquad
