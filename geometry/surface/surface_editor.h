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

  /// Triangles that hold both nodes, ascending: empty when there is no such edge.
  std::vector<int> triangles_on(int a, int b) const;
  /// The same, into a vector whose memory is used again.
  void find_triangles_on(int a, int b, std::vector<int>& found) const;
  /// Returns the index of the line between two nodes, -1: none.
  int line_on(int a, int b) const;
  bool is_on_line(int node) const { return !lines_at_[node].empty(); }
  std::span<const int> triangles_at(int node) const { return triangles_at_[node]; }

  /// Puts a new node on an existing edge; splits its triangles and its line. Returns the node.
  int split_edge(int a, int b, const Vec3& x);
  /// Puts a new node inside a triangle, which becomes three. Returns the node.
  int split_triangle(int triangle, const Vec3& x);
  /// Turns the edge that two triangles share, if it is not a line and the other diagonal is no edge yet.
  bool flip_edge(int a, int b);
  /// Adds a curve of lines along existing edges; the last node equals the first one when it is closed.
  /// Returns its index.
  int add_curve(std::span<const int> chain);

  /// Pairs (triangle that was split, half that was added), in order.
  const std::vector<std::pair<int, int>>& splits() const { return splits_; }

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
