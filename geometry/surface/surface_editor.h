// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "geometry/surface/surface_model.h"

// This header edits fine triangulations. Features and geometry use it.

namespace delquad {

/// Refines the fine triangulation of a model in place: sides are split and flipped, curves are added, and
/// lines keep following their curves. Triangles keep their indices; halves that a split adds come last. Call
/// finish() before the model's lines are read again.
class SurfaceEditor {
 public:
  explicit SurfaceEditor(SurfaceModel& model);

  /// Returns the triangles with both nodes, ascending; empty if there is no such edge.
  std::vector<int> triangles_on(int a, int b) const;
  /// Does the same in `found`, whose memory is reused.
  void find_triangles_on(int a, int b, std::vector<int>& found) const;
  /// Returns the index of the line between two nodes; -1: none.
  int line_on(int a, int b) const;
  bool is_on_line(int node) const { return !lines_at_[node].empty(); }
  std::span<const int> triangles_at(int node) const { return triangles_at_[node]; }

  /// Puts a new node at x on an existing edge, and splits its triangles and its line. Returns the node.
  int split_edge(int a, int b, const Vec3& x);
  /// Puts a new node at x inside a triangle, which becomes three. Returns the node.
  int split_triangle(int triangle, const Vec3& x);
  /// Flips the edge that two triangles share. Returns false, without a change, if it is a line or the other
  /// diagonal is an edge already.
  bool flip_edge(int a, int b);
  /// Adds a curve of lines along existing edges; the last node of a closed one equals the first. Returns its
  /// index.
  int add_curve(std::span<const int> chain);

  /// Returns the pairs (split triangle, added half), in order.
  const std::vector<std::pair<int, int>>& splits() const { return splits_; }

  /// Puts the lines of each curve in order again.
  void finish();

 private:
  void index_lines();
  int add_node(const Vec3& x);
  void replace_corner(int triangle, int from, int to);

  Mesh& mesh_;
  std::vector<std::vector<int>> triangles_at_, lines_at_;
  std::vector<int> next_line_;  ///< of each line the one that was split off it, -1: none
  std::vector<char> begins_;    ///< lines that were not split off another one
  std::vector<std::pair<int, int>> splits_;
};

}  // namespace delquad
