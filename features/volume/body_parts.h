// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
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

/// A face between a void and the skin or a cell, counterclockwise seen from outside of the void.
struct OpenFace {
  Quad nodes;  ///< the last is -1 for a triangle
  int owner;   ///< face of the skin, quads first; -1 - i: cell i, hexahedra first

  std::span<const int> corners() const { return std::span(nodes).first(nodes[3] < 0 ? 3 : 4); }
};
/// Returns the faces of the skin and the sides of cells that no other one touches, quads first.
std::vector<OpenFace> open_faces(const Mesh& body);

/// Returns quads with their points, in the order of use, and the numbers that these had.
Mesh part_with(const std::vector<Vec3>& points, std::span<const Quad> quads, std::vector<int>& numbers);
/// Appends a cell; the number of nodes tells its shape.
void add_cell(Mesh& mesh, std::span<const int> nodes, int volume);
/// Appends all cells of a mesh. Its points have numbers in the other mesh. Where these end, or are -1, points
/// are appended.
void add_cells(Mesh& mesh, const Mesh& from, std::vector<int> numbers, int volume);
/// Removes cells, hexahedra first, and puts the others into volume 0.
void drop_cells(Mesh& mesh, const std::vector<int>& cells);

}  // namespace delquad
