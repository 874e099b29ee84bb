// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <initializer_list>
#include <utility>
#include <vector>

#include "delquad/mesh.h"

// This header has tetrahedra and pyramids that can be edited. The filling of voids uses it.

namespace delquad {

/// Corners of a pyramid, or of a tetrahedron and -1, in the order of Mesh.
using Cell = std::array<int, 5>;

inline int n_corners(const Cell& cell) { return cell[4] < 0 ? 4 : 5; }
inline bool has_corner(const Cell& cell, int v) {
  return cell[0] == v || cell[1] == v || cell[2] == v || cell[3] == v || cell[4] == v;
}

/// Returns the scaled Jacobian as in metrics/cells.h. The apex of a pyramid counts, too, with each three
/// neighboring edges.
double quality_of(const std::array<Vec3, 5>& corners, bool is_pyramid);

/// Tetrahedra and pyramids with their cells at each vertex.
class CellMesh {
 public:
  /// The first points are fixed.
  CellMesh(std::vector<Vec3> points, std::size_t n_fixed)
      : points_(std::move(points)), at_(points_.size()), n_fixed_(static_cast<int>(n_fixed)) {}

  const std::vector<Vec3>& points() const { return points_; }
  const std::vector<Cell>& cells() const { return cells_; }
  bool is_alive(int c) const { return cells_[c][0] >= 0; }
  bool is_free(int v) const { return v >= n_fixed_; }
  double quality(int c) const { return quality_[c]; }
  /// Returns the quality of any cell, with vertex `v` at x; -1: all vertices at their places.
  double quality_with(const Cell& cell, int v = -1, const Vec3& x = {}) const;
  const std::vector<int>& at(int v) const { return at_[v]; }

  int add_point(const Vec3& p);
  void add(const Cell& cell);
  void remove(int c);
  void move(int v, const Vec3& to);

  /// Returns the cells with these corners, lower indices first.
  std::vector<int> cells_with(std::initializer_list<int> corners) const;
  /// Returns the least quality of cells; 1 without cells.
  double least(const std::vector<int>& cells) const;
  /// Replaces cells if the least quality grows by more than `gain`. Returns whether it did.
  bool replace(const std::vector<int>& old, const std::vector<Cell>& by, double gain);
  /// Returns the vertices around an edge a, b, counterclockwise seen from b; empty unless only tetrahedra
  /// have it. `is_open` tells that the last and the first vertex share no cell.
  std::vector<int> ring(int a, int b, bool& is_open) const;

 private:
  std::vector<Vec3> points_;
  std::vector<Cell> cells_;
  std::vector<double> quality_;
  std::vector<std::vector<int>> at_;
  int n_fixed_;
};

/// Moves a free vertex until the least quality of its cells stays the same; returns the gain.
double relocate(CellMesh& mesh, int v);

/// Improves the cells below a quality by moves of vertices, and by removals and collapses of edges. The least
/// quality never falls. Own order of known operations.
void improve(CellMesh& mesh, double wanted);

}  // namespace delquad
