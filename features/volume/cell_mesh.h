// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <initializer_list>
#include <span>
#include <utility>
#include <vector>

#include "delquad/mesh.h"

// This header has tetrahedra and pyramids that can be edited. The filling of voids uses it.

namespace delquad {

/// Corners of a hexahedron, prism, pyramid or tetrahedron in the order of Mesh, then -1.
using Cell = std::array<int, 8>;

/// Returns a cell of given corners.
template <class Corners>
Cell cell_of(const Corners& corners) {
  Cell cell;
  cell.fill(-1);
  std::ranges::copy(corners, cell.begin());
  return cell;
}
inline int n_corners(const Cell& cell) { return cell[4] < 0 ? 4 : cell[5] < 0 ? 5 : cell[6] < 0 ? 6 : 8; }
inline std::span<const int> nodes_of(const Cell& cell) { return std::span(cell).first(n_corners(cell)); }
inline bool is_pyramid(const Cell& cell) { return cell[4] >= 0 && cell[5] < 0; }
/// Returns whether this is a hexahedron or prism.
inline bool is_block(const Cell& cell) { return cell[5] >= 0; }
inline bool has_corner(const Cell& cell, int v) { return std::ranges::find(cell, v) != cell.end(); }

/// Cells with their lists at each vertex.
class CellMesh {
 public:
  /// Vertices that are `fixed` stay at their places; later ones are free.
  CellMesh(std::vector<Vec3> points, std::vector<char> fixed)
      : points_(std::move(points)), at_(points_.size()), fixed_(std::move(fixed)) {
    fixed_.resize(points_.size(), 0);
  }

  const std::vector<Vec3>& points() const { return points_; }
  const std::vector<Cell>& cells() const { return cells_; }
  bool is_alive(int c) const { return cells_[c][0] >= 0; }
  bool is_fixed(int v) const { return fixed_[v]; }
  /// Returns whether a vertex is neither fixed nor one of a hexahedron or prism.
  bool is_free(int v) const;
  double quality(int c) const { return quality_[c]; }
  /// Returns the quality of any cell, with vertex `v` at x; -1: all vertices at their places. It is the
  /// scaled Jacobian as in metrics/cells.h; the apex of a pyramid counts, too, with each three neighboring
  /// edges. Hexahedra and prisms have 1 if they are good enough, otherwise -1.
  double quality_with(const Cell& cell, int v = -1, const Vec3& x = {}) const;
  const std::vector<int>& at(int v) const { return at_[v]; }

  int add_point(const Vec3& p);
  void add(const Cell& cell);
  void remove(int c);
  void move(int v, const Vec3& to);
  /// Tells the present state to undo(). States lie within each other.
  std::size_t state() const { return changes_.size(); }
  /// Takes all changes since a state back.
  void undo(std::size_t state);

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
  /// A cell that came or went, or a vertex (-1: none) that moved.
  struct Change {
    int cell, vertex;
    Cell corners;  ///< of a cell that went
    Vec3 from;
  };

  std::vector<Vec3> points_;
  std::vector<Cell> cells_;
  std::vector<double> quality_;
  std::vector<std::vector<int>> at_;
  std::vector<char> fixed_;
  std::vector<Change> changes_;
};

/// Moves a vertex until the least quality of its cells stays the same; returns the gain.
double relocate(CellMesh& mesh, int v);

/// Improves cells by moves of vertices, and by removals and collapses of edges. Divides hexahedra and prisms
/// beside poor cells into pyramids and tetrahedra, one by one, where that makes the poor ones better. Removes
/// free vertices where cells stay good. Own order of known operations.
void improve(CellMesh& mesh);

}  // namespace delquad
