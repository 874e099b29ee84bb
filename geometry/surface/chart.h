// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "delquad/mesh.h"

// This header has charts, connected pieces of faces. Features, geometry and fields use it.

namespace delquad {

/// A connected piece of one face of a fine triangulation, bounded by lines on all sides. A point that lines
/// divide is several vertices, one for each sector of triangles around it.
struct Chart {
  int face = -1;  ///< index into Mesh::regions
  std::vector<Vec3> points;
  std::vector<int> fine_node;  ///< fine point of each vertex; vertices of loops come first, in order
  std::vector<std::array<int, 3>> triangles;
  std::vector<std::array<int, 3>> neighbours;  ///< across the side opposite to vertex k; -1: boundary
  std::vector<int> fine_triangle;              ///< fine triangle of each triangle
  std::vector<std::vector<int>> loops;         ///< vertices, the chart on the left; the longest loop first
  int n_boundary = 0;                          ///< number of vertices on loops
  /// Lengths, by another metric, of the sides opposite to each corner of each triangle. They replace lengths
  /// between points. Empty: none.
  std::vector<std::array<double, 3>> sides = {};
};

/// Returns the corners of a triangle with sides of these lengths opposite to them, or a flat one if they
/// allow none.
std::array<Vec3, 3> corners_at(const std::array<double, 3>& sides);
/// Returns the corners of a triangle, or corners_at() its `sides`.
std::array<Vec3, 3> corners_of(const Chart& chart, int triangle);

/// Returns the charts of the wanted triangles, in the order of their first triangles. Throws InputError for a
/// side that is neither a line nor shared by two triangles of one face that agree in orientation. Lines (by
/// index) that are `open` (empty: none) do not bound charts between wanted triangles of one face.
std::vector<Chart> extract_charts(const Mesh& fine, const std::vector<char>& wanted,
                                  const std::vector<char>& open = {});

/// Returns the number of handles: 0 for a disk, an annulus, a sphere.
int genus(const Chart& chart);

/// Returns the lengths of the sides of a disk's boundary, from each vertex to the next.
std::vector<double> boundary_lengths(const Chart& chart);

/// Returns the area of each triangle.
std::vector<double> triangle_areas(const Chart& chart);

/// Returns the triangles around each vertex, ascending.
std::vector<std::vector<int>> triangles_around(const Chart& chart);

/// Returns, in radians, 2 pi minus the angles around each inner vertex, and pi minus the angles on the
/// boundary.
std::vector<double> angle_defects(const Chart& chart);

}  // namespace delquad
