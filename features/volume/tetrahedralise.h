// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "delquad/mesh.h"

// This header fills closed triangulations with tetrahedra. The filling of voids uses it.

namespace delquad {

/// Tetrahedra with corners as in Mesh::tetrahedra.
struct Tetrahedra {
  std::vector<Vec3> points;  ///< all given points, then new points off the triangles
  std::vector<std::array<int, 4>> cells;
};

/// Returns a constrained Delaunay tetrahedralization by TetGen, in a separate process. All regions that
/// triangles enclose are filled, also cavities; `holes` are points of regions to leave out. The triangles
/// should be faces of tetrahedra, but TetGen may lose some. Returns nothing if TetGen refuses the triangles,
/// crashes or exceeds its time. Source: [si2015].
std::optional<Tetrahedra> tetrahedralise(const std::vector<Vec3>& points,
                                         const std::vector<std::array<int, 3>>& triangles,
                                         const std::vector<Vec3>& holes);

}  // namespace delquad
