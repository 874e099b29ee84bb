#pragma once

#include <array>
#include <string>
#include <vector>

#include "delquad/mesh.h"

namespace delquad {

/// Whether the triangle's height is more than what rounding leaves of collinear points (1e-12 of its longest
/// side).
bool has_area(const std::vector<Vec3>& points, const std::array<int, 3>& v);

/// Triangles that were taken out, and a vertex of the first.
struct FlatTriangles {
  int count = 0;
  Vec3 first;
};

/// Takes out the triangles without area so that no gap opens: the ends of a side without length become one
/// vertex, and where a triangle has its third vertex between the others, all triangles on its longest side
/// are cut there. Once they are, its boundary is zero modulo two, so that each edge stays in an even or an
/// odd number of triangles: what is closed stays closed. Of triangles that come to lie on the same vertices,
/// two go. Lines on what is cut are cut, too. `count` is that of the triangles that were given. Throws
/// InputError, beginning with `source`, where such triangles lie on each other in so many ways that there is
/// no end.
FlatTriangles take_out_flat_triangles(Mesh& mesh, const std::string& source);

}  // namespace delquad
