// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "delquad/mesh.h"

// This header has neighbors and edits of triangles. Features, geometry, stages and smoothing use it.

namespace delquad {

/// Returns the side (0 to 2) of triangle t that faces triangle u; -1 if they share none.
int facing_side(const TriPatch& tri, int t, int u);

/// Finds the neighbors of all triangles, by their corners.
void link_neighbours(TriPatch& tri);

/// Swaps side k of t, across which lies a triangle u, for the other diagonal of the two. Let a be the corner
/// opposite of the side in t, b the next one and d the corner opposite in u. Then t begins with a, b, d and u
/// with a, d.
void swap_side(TriPatch& tri, int t, int k);

/// Cuts side k of t, across which lies a triangle u, at a point, which becomes the last one. The triangles t
/// and u keep their parts at the side's first end (the corner after k). The two last triangles are the other
/// parts, t's first.
void split_side(TriPatch& tri, int t, int k, Vec2 at);

/// One corner of a triangle; side k lies opposite of it.
struct TriCorner {
  int t, k;
};

/// A triangulation with local edits. Removed triangles and vertices stay as dead slots.
class TriTopology {
 public:
  explicit TriTopology(TriPatch tri);

  /// Returns the mesh without its dead slots; points keep their order.
  TriPatch to_patch() const;

  int triangle_slots() const { return static_cast<int>(tri_.triangles.size()); }
  int vertex_slots() const { return static_cast<int>(tri_.points.size()); }
  bool alive(int t) const { return tri_.triangles[t][0] >= 0; }
  bool vertex_alive(int i) const { return triangle_of_[i] >= 0; }
  bool on_boundary(int i) const { return i < tri_.n_boundary; }
  const Vec2& point(int i) const { return tri_.points[i]; }
  void move(int i, Vec2 to) { tri_.points[i] = to; }
  /// Returns the vertex at corner k, where k may be 3 or 4 for 0 and 1.
  int vertex(int t, int k) const { return tri_.triangles[t][k % 3]; }
  /// Returns the triangle across side k; -1: boundary.
  int across(int t, int k) const { return tri_.neighbours[t][k]; }
  /// Returns the corner of u opposite of its side to t, a neighbor.
  int facing(int u, int t) const { return facing_side(tri_, u, t); }

  /// Sets `corners` to the corners at a live inner vertex, counterclockwise.
  void star(int i, std::vector<TriCorner>& corners) const;
  /// Returns the corner opposite of an inner edge, in one of its triangles; t < 0 if a and b have no inner
  /// edge.
  TriCorner find_inner_edge(int a, int b) const;
  /// Returns whether an edge joins two vertices; boundary edges count.
  bool adjacent(int a, int b) const;

  /// Edit the mesh as swap_side() and split_side() do. split() returns the new vertex.
  void swap(int t, int k);
  int split(int t, int k, Vec2 at);
  /// Removes inner vertex `from` by merging it into its neighbor `to`; `star` has the corners at `from`.
  void collapse(int from, int to, const std::vector<TriCorner>& star);

 private:
  int corner_at(int t, int i) const;
  void note(int t);

  TriPatch tri_;                  ///< dead triangles have -1 for their vertices
  std::vector<int> triangle_of_;  ///< of each vertex one of its triangles; -1: dead
};

}  // namespace delquad
