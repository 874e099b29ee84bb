// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "delquad/mesh.h"
#include "features/volume/body_parts.h"
#include "features/volume/cell_mesh.h"

// This header fills the space between quads and triangles with pyramids and tetrahedra. Volume meshes use it.

namespace delquad {

/// The closed boundary of a void. Faces run counterclockwise seen from outside of the void.
struct VoidBoundary {
  std::vector<Vec3> points;  ///< points of no face are left out
  std::vector<Quad> quads;
  std::vector<Triangle> triangles;
  std::vector<Cell> blocks;  ///< hexahedra and prisms beside the void
  std::vector<char> fixed;   ///< by point, whether it stays at its place
};
/// Returns the boundary of the void in a body of hexahedra and prisms with these open_faces(). Points of the
/// skin are fixed.
VoidBoundary boundary_of(const Mesh& body, const std::vector<OpenFace>& faces);

struct Filling {
  std::vector<Vec3> points;  ///< the given points, then new ones
  std::vector<Cell> cells;   ///< blocks too, as far as they remain
  /// Faces, quads first, at which the filling fails. All are listed if TetGen fails. If the
  /// list is empty, each quad is the base of a pyramid, and all cells are positive.
  std::vector<int> lost;
};

/// A cell below this quality counts as flat. It is far above rounding.
inline constexpr double kLeastQuality = 1e-6;

/// Turns quads until their triangles by the diagonals from the first corners neither cross each other nor
/// coincide. `triangles` stay as they are. Returns the faces, quads first, that still do, and where the first
/// does.
std::vector<int> untangle(const std::vector<Vec3>& points, std::vector<Quad>& quads,
                          const std::vector<Triangle>& triangles, Vec3* where = nullptr);

/// Fills a void. Tetrahedra come from tetrahedralise(). Two of them on a quad with a common apex become a
/// pyramid. Elsewhere a new vertex splits the diagonal of the quad and is raised. Then cells are improved, if
/// asked; blocks beside poor ones give way.
Filling fill_void(const VoidBoundary& boundary, bool improve);

}  // namespace delquad
