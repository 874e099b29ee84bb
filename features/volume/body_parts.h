// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "delquad/mesh.h"

// This header has faces of bodies, and copies their points and cells. The filling of volumes uses it.

namespace delquad {

using Quad = std::array<int, 4>;
using Triangle = std::array<int, 3>;

/// Returns both triangles of each quad, by its diagonal from the first corner.
std::vector<Triangle> halves_of(std::span<const Quad> quads);

/// Returns the vector of unit length along v; v if it has no length.
inline Vec3 direction_of(const Vec3& v) {
  const double length = norm(v);
  return length > 0 ? (1 / length) * v : v;
}

/// Returns the mean of points.
Vec3 middle_of(const std::vector<Vec3>& points, std::span<const int> numbers);

/// Angles around the edge from a to b, counterclockwise seen from b; 0 at a point.
class AngleAround {
 public:
  AngleAround(const Vec3& a, const Vec3& b, const Vec3& zero);
  double operator()(const Vec3& p) const { return std::atan2(dot(p - origin_, y_), dot(p - origin_, x_)); }

 private:
  Vec3 origin_, x_, y_;
};

/// The faces between a void and the skin or cells, counterclockwise seen from outside of the void.
struct VoidFaces {
  std::vector<Quad> quads;
  std::vector<Triangle> triangles;
  std::vector<int> owners;  ///< face of the skin, or -1 - i: cell i; quads first, hexahedra first

  std::span<const int> nodes(std::size_t face) const {
    if (face < quads.size()) return quads[face];
    return triangles[face - quads.size()];
  }
};
/// Returns the faces of the skin and the sides of cells that no other one touches.
VoidFaces open_faces(const Mesh& body);

/// Removes the points that no element uses. Returns the numbers that the others had.
std::vector<int> keep_used_points(Mesh& part);
/// Appends a cell; the number of nodes tells its shape.
void add_cell(Mesh& mesh, std::span<const int> nodes, int volume);
/// Appends all cells of a mesh. Its points have numbers in the other mesh. Where these end, or are -1, points
/// are appended.
void add_cells(Mesh& mesh, const Mesh& from, std::vector<int> numbers, int volume);
/// Removes cells, hexahedra first, and puts the others into volume 0.
void drop_cells(Mesh& mesh, const std::vector<int>& cells);

}  // namespace delquad
