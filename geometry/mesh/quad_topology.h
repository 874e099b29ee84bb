// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "base/marks.h"
#include "delquad/mesh.h"

// This header edits quad meshes. Features, geometry, stages and smoothing use it.

namespace delquad {

/// A quad mesh of one patch in its parameter plane, with local edits that can be undone.
///
/// Half-edge h = 4 * element + corner runs counterclockwise from its corner to the next; twin(h) lies across,
/// -1 on the boundary. Removed elements and vertices stay as dead slots, which to_patch() leaves out. An edit
/// needs its can_ function to hold. Leftover triangles are elements too; only remove_doublet() touches them.
class QuadTopology {
 public:
  /// Throws std::invalid_argument, with the vertices, if two elements run along an edge in the same
  /// direction. It also throws if a boundary edge ends in an interior point, or a vertex index is out of
  /// range.
  explicit QuadTopology(const QuadPatch& mesh) : QuadTopology(mesh, mesh.n_boundary) {}
  /// Does the same; the boundary's points from `first_held` on are held, see QuadBlock.
  QuadTopology(const QuadPatch& mesh, int first_held);

  /// Returns the mesh: boundary points first, then live interior ones, each in the order of their creation;
  /// live elements likewise.
  QuadPatch to_patch() const;

  /// Return the numbers of slots, dead ones included.
  int vertex_slots() const { return static_cast<int>(points_.size()); }
  int element_slots() const { return static_cast<int>(corner_.size() / 4); }
  bool vertex_alive(int v) const { return out_[v] >= 0; }
  bool alive(int element) const { return corner_[4 * element] >= 0; }
  /// Returns whether the element is a quad; false for triangles and for dead slots.
  bool is_quad(int element) const { return corner_[4 * element + 3] >= 0; }
  bool on_boundary(int v) const { return v < n_boundary_; }
  /// Returns whether the vertex is held: on the boundary, with elements of other blocks.
  bool held(int v) const { return v < n_boundary_ && v >= first_held_; }
  bool any_held() const { return first_held_ < n_boundary_; }
  /// Returns whether v or one of its neighbors is held.
  bool near_held(int v) const {
    bool near = held(v);
    if (any_held()) for_each_out(v, [&](int h) { near |= held(target(h)) || held(origin(prev(h))); });
    return near;
  }

  static int element(int h) { return h >> 2; }
  /// Returns the vertex at a corner (0 to 3) of an element; -1 for the fourth of a triangle.
  int corner(int element, int k) const { return corner_[4 * element + k]; }
  int origin(int h) const { return corner_[h]; }
  int target(int h) const { return corner_[next(h)]; }
  int twin(int h) const { return twin_[h]; }
  int next(int h) const {
    const int k = h & 3;
    return k == 3 || (k == 2 && corner_[h + 1] < 0) ? h - k : h + 1;
  }
  int prev(int h) const { return (h & 3) != 0 ? h - 1 : corner_[h + 3] < 0 ? h + 2 : h + 3; }
  /// Returns a half-edge that leaves v; the boundary's own one for a boundary vertex.
  int out(int v) const { return out_[v]; }
  /// Returns the half-edge after h counterclockwise around its origin; -1 past the last element of a boundary
  /// vertex.
  int around(int h) const { return twin_[prev(h)]; }
  /// Returns the number of elements at v.
  int valence(int v) const { return valence_[v]; }
  Vec2 point(int v) const { return points_[v]; }
  /// Returns whether an edge joins two vertices.
  bool adjacent(int a, int b) const;

  /// Calls f(h) for the half-edges that leave v, counterclockwise, one in each element.
  template <class F>
  void for_each_out(int v, F&& f) const {
    int h = out_[v];
    do {
      f(h);
      h = around(h);
    } while (h >= 0 && h != out_[v]);
  }

  /// Returns the hexagon of the two quads at an interior edge, counterclockwise: h's target first, its origin
  /// fourth.
  std::array<int, 6> hexagon(int h) const;
  /// Returns whether both elements at h are quads and the rotated edge would be new.
  bool can_rotate(int h, bool counterclockwise) const;
  /// Rotates edge h within its hexagon: its ends go to the next corners (counterclockwise or clockwise).
  /// Returns the half-edge of the new edge in h's element; other half-edges of both quads change.
  int rotate(int h, bool counterclockwise);

  /// Returns whether both elements at h are quads with six different corners.
  bool can_open(int h) const;
  /// Rotates edge h as rotate() does, and opens it to two more quads. Each next corner gets an edge to a new
  /// vertex; each end of h is joined to one of these. The new vertices are the last slots.
  void open(int h, bool counterclockwise);

  /// Returns whether the opposite corner of h's quad can be merged into h's origin.
  bool can_collapse(int h) const;
  /// Removes h's quad by merging its opposite corner (interior) into h's origin, which keeps its place.
  void collapse(int h);

  /// Returns whether half-edges `from` and `to` leave one vertex, by interior edges, with at least two
  /// elements on either side. One suffices on the side that holds a boundary.
  bool can_split(int from, int to) const;
  /// Inverts collapse(): opens both edges to a new quad. The elements from `from`'s counterclockwise to the
  /// one before `to`'s leave the vertex for a new one, the last slot, at the same place.
  void split(int from, int to);

  /// Returns whether v is inside, with two elements that make one.
  bool can_remove_doublet(int v) const;
  /// Removes an interior vertex between two elements, which become one.
  void remove_doublet(int v);

  /// Returns whether the outline of these quads passes no vertex twice.
  bool can_pillow(std::span<const int> quads) const;
  /// Shrinks the quads and fills the gap with a ring of quads, one for each side of their outline. The new
  /// vertices, one for each on the outline, are the last slots. A single quad becomes five.
  void pillow(std::span<const int> quads);

  /// Replaces quads by other ones. `rim` has the half-edges of their outline, one loop, counterclockwise. In
  /// `fill` vertex i is the origin of rim[i]; the next ones are new vertices, the last slots, at `inside`.
  /// Vertices within the outline are removed. Returns false, without a change, if two vertices would get a
  /// second edge.
  bool refill(std::span<const int> quads, std::span<const int> rim, std::span<const Vec2> inside,
              std::span<const std::array<int, 4>> fill);

  /// Moves a vertex to a finite place.
  void move(int v, Vec2 to);

  /// A state to which rollback() returns.
  struct Mark {
    std::size_t ints, moves, vertices, elements;
  };
  Mark mark() const { return {int_log_.size(), move_log_.size(), points_.size(), corner_.size() / 4}; }
  /// Undoes all edits since a mark. None may be final since then.
  void rollback(const Mark& mark);
  /// Makes all edits so far final; earlier marks are no longer valid.
  void commit() { int_log_.clear(), move_log_.clear(); }

 private:
  using Array = std::vector<int> QuadTopology::*;
  struct IntChange {
    Array array;
    int index, old;
  };
  struct MoveChange {
    int vertex;
    Vec2 old;
  };

  std::vector<int> outline(std::span<const int> quads) const;
  bool has_double_edge(std::span<const int> vertices) const;
  void write(Array which, int index, int value);
  void add_to_valence(int v, int change) { write(kValence, v, valence_[v] + change); }
  void link(int h, int twin);
  /// Fills an element's slot; `twins` belong to its sides.
  void set_element(int element, std::array<int, 4> corners, std::array<int, 4> twins);
  void kill_element(int element);
  int add_element();
  int add_vertex(Vec2 at);
  void build_twins();

  int n_boundary_ = 0, first_held_ = 0;
  std::vector<Vec2> points_;
  std::vector<int> corner_, twin_;  // by half-edge; corner -1: no such corner
  std::vector<int> out_, valence_;  // by vertex; out -1: dead
  static constexpr Array kCorner = &QuadTopology::corner_, kTwin = &QuadTopology::twin_,
                         kOut = &QuadTopology::out_, kValence = &QuadTopology::valence_;
  std::vector<IntChange> int_log_;
  std::vector<MoveChange> move_log_;
};

/// Calls f(element) for the elements around these vertices, each once; dead vertices are skipped. `met` marks
/// elements in a pass of the caller.
template <class Vertices, class F>
void for_each_element_around(const QuadTopology& mesh, const Vertices& vertices, Marks& met, F&& f) {
  for (const int v : vertices)
    if (mesh.vertex_alive(v))
      mesh.for_each_out(v, [&](int h) {
        if (const int e = QuadTopology::element(h); met.meet(e)) f(e);
      });
}

}  // namespace delquad
