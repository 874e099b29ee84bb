// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "delquad/hexahedra.h"

// This header measures cells of volumes, and proves meshes of them sound. Meshers of volumes and the program
// use it.

namespace delquad {

template <std::size_t N>
std::array<Vec3, N> corners_of(const std::vector<Vec3>& points, const std::array<int, N>& cell) {
  std::array<Vec3, N> at;
  for (std::size_t k = 0; k < N; ++k) at[k] = points[cell[k]];
  return at;
}

// Functions take the corners of a hexahedron, prism, pyramid or tetrahedron, whose number tells the shape.

/// Returns the least value of all corners but the apex of a pyramid, at most 1. It is the determinant of unit
/// vectors along the edges, times 2/sqrt(3) in prisms and sqrt(2) in pyramids and tetrahedra. So a cell whose
/// edges have one length and whose quads are squares has 1.
double scaled_jacobian(std::span<const Vec3> corners);

/// Returns the volume under the (tri)linear map, positive if the corners are in order. Faces of four corners
/// are bilinear.
double signed_volume(std::span<const Vec3> corners);

/// A Jacobian below this part of the product of three edge lengths counts as zero. It is far above rounding
/// of flat cells, and far below the needs of solvers.
inline constexpr double kLeastCellJacobian = 1e-9;

/// Returns whether the Jacobian of the map is positive in the whole cell. Hexahedra are proven by Bernstein
/// coefficients of them and their parts, as in [johnen2013]; false if that stays open. In prisms it is
/// quadratic along three edges and linear between them, in pyramids bilinear between four corners: there the
/// answer is exact.
bool is_positive(std::span<const Vec3> corners);

/// Returns the defects of a mesh of cells, one line for each kind with the place of the first; empty: it is
/// sound. A sound mesh has no cells that overlap, if its skin does not cross itself.
///
/// * Each side of a cell is a side of another cell in opposite cyclic order, or a face of the mesh that looks
///   outwards. Other faces lie between two cells, and none is there twice.
/// * No quad meets triangles.
/// * Each cell has distinct corners and is_positive().
/// * The cells and the skin of bilinear quads have the same volume, to 1e-9 of it.
std::vector<std::string> defects_of_cells(const Mesh& mesh);

}  // namespace delquad
