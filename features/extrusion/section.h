// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "delquad/hexahedra.h"
#include "delquad/mesh.h"

// This header prepares quads for a sweep. Features use it.

namespace delquad {

/// An edge of the section that a face grows from.
struct WallEdge {
  int a, b;   ///< the quad lies on the left
  int quad;   ///< the first that it is an edge of
  int curve;  ///< index into Mesh::curves; -1: no line lies there
  bool on_boundary;
};

/// The section that is swept: quads that run the same way round as their neighbors.
struct Section {
  Mesh mesh;              ///< quads, and points that they use
  std::vector<int> part;  ///< of each quad: those that hang together by edges
  int n_parts = 0;
  std::vector<WallEdge> walls;  ///< all edges on the boundary; those inside whose line has a name
};

/// Throws InputError with the place. `notes` learns what is left out.
Section make_section(const Mesh& mesh, ReadNotes* notes);

/// Returns a vector of length 1 at right angles to a vector that is not 0.
Vec3 unit_across(const Vec3& v);

/// Throws InputError unless a line has two points, no two of which in a row are the same, and does not close.
void check_open_line(const std::vector<Vec3>& line);

/// Returns the points of a polyline at parts of its length, from 0 to 1. For each corner, where segments turn
/// by 40 degrees or more, the nearest of them moves there. Throws InputError where there is none for a
/// corner.
std::vector<Vec3> points_at_lengths(const std::vector<Vec3>& line, const std::vector<double>& parts);

/// A section that moves along a polyline without a turn about it. Between two points of the line it keeps its
/// profile, seen along the segment. At the points it lies at right angles to the tangents there. So it stays
/// as it is along a circle, and legs that meet at a corner are mitred.
class MovingSection {
 public:
  /// Throws InputError as check_open_line() does, and with the place where the line turns back.
  explicit MovingSection(std::vector<Vec3> line);
  /// Returns a place beside the first point of the line, and where it is at point `i`.
  Vec3 place(const Vec3& p, std::size_t i) const;

 private:
  /// Three unit vectors at right angles.
  struct Frame {
    Vec3 along, first, second;
  };
  std::vector<Vec3> line_, tangents_;
  std::vector<Frame> frames_;  ///< of the segments, each turned from the one before by the least turn
};

}  // namespace delquad
