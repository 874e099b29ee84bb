// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <span>
#include <vector>

#include "delquad/mesh.h"

// This header inserts points into a constrained Delaunay triangulation. Geometry and stages use it.

namespace delquad {

/// Indexed constrained Delaunay triangulation that grows by single points (Bowyer-Watson [rebay1993] with
/// exact predicates). Cavities stop at boundary sides, which have no neighbor.
class DelaunayKernel {
 public:
  struct Triangle {
    std::array<int, 3> v;  ///< counterclockwise
    std::array<int, 3> n;  ///< n[k] lies across the side opposite to v[k]; -1: boundary
  };
  /// An edge of the cavity's shell; the new point lies on its left.
  struct ShellEdge {
    int a, b;
    int outer;       ///< triangle beyond, -1 on the boundary
    int inner;       ///< cavity triangle that owns the edge
    int inner_side;  ///< side of this triangle, 0 to 2
  };

  /// Starts from a constrained Delaunay triangulation.
  explicit DelaunayKernel(const TriPatch& initial);

  const std::vector<Vec2>& points() const { return points_; }
  const std::vector<Triangle>& triangles() const { return triangles_; }

  /// Returns the triangle that holds x, found by a visibility walk from triangle `start`; -1 if the walk
  /// leaves the domain.
  int locate(Vec2 x, int start) const;

  /// Finds the triangles whose circumcircles contain x, which lies in `triangle`. Returns false if x lies on
  /// the boundary or on a vertex. The triangulation does not change until insert().
  bool find_cavity(Vec2 x, int triangle);
  std::span<const int> cavity() const { return cavity_; }
  /// Returns the edges of the shell, counterclockwise.
  std::span<const ShellEdge> shell() const { return shell_; }

  /// Replaces the last found cavity by the star of x, whose index is points().size() - 1 afterwards. Returns
  /// the new triangles: the k-th is (x, a, b) over the k-th shell edge. The cavity's indices are used again.
  std::span<const int> insert(Vec2 x);

  /// Returns the triangulation; the first `n_boundary` points are on the boundary.
  TriPatch to_patch(int n_boundary) const;

 private:
  int side_of(int triangle, int neighbour) const;

  std::vector<Vec2> points_;
  std::vector<Triangle> triangles_;
  std::vector<int> cavity_, star_;
  std::vector<ShellEdge> shell_;
  std::vector<std::array<int, 2>> stack_;
};

}  // namespace delquad
