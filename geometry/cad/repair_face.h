#pragma once

#include <array>
#include <vector>

#include "delquad/mesh.h"

namespace delquad::cad {

/// Makes the triangles of one face end where its boundary does. `boundary` holds the sides that the face's
/// edges have, each in the direction in which its triangle runs along it; the two sides of a seam cancel.
/// Where edges meet at a cusp or a pole the kernel leaves gaps, and pairs of triangles folded onto each
/// other: gaps are filled with the triangles of least area, pairs removed. Returns the greatest ratio of a
/// gap's area to its perimeter, a length: how far off the boundary was.
double repair_face(const std::vector<Vec3>& points, const std::vector<std::array<int, 2>>& boundary,
                   std::vector<std::array<int, 3>>& triangles);

/// True when no side belongs to more than two of the triangles.
bool is_manifold(const std::vector<std::array<int, 3>>& triangles);

}  // namespace delquad::cad
