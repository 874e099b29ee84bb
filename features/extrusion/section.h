// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "delquad/hexahedra.h"
#include "delquad/mesh.h"

// This header prepares quads for a sweep. Features use it.

namespace delquad {

/// An edge of the section from which a face grows.
struct WallEdge {
  int a, b;   ///< the quad lies on the left
  int quad;   ///< the first quad with this edge
  int curve;  ///< index into Mesh::curves; -1: no line lies there
  bool on_boundary;
};

/// The section that is swept: quads with the same orientation as their neighbors.
struct Section {
  Mesh mesh;              ///< quads, and points that they use
  std::vector<int> part;  ///< number of the edge-connected part of each quad
  int n_parts = 0;
  std::vector<WallEdge> walls;  ///< all edges on the boundary; inner edges whose line has a name
};

/// Returns the quads of a mesh as a section; `notes` tells the omissions. Throws InputError, with the place,
/// for meshes that extrude() refuses.
Section make_section(const Mesh& mesh, ReadNotes* notes);

/// Returns a unit vector perpendicular to a vector that is not 0.
Vec3 unit_across(const Vec3& v);

/// Throws InputError, with the place, unless a line has two points or more, no equal ones in a row, and does
/// not close.
void check_open_line(const std::vector<Vec3>& line);

/// Returns the points of a polyline at shares of its length, from 0 to 1. For each corner, where segments
/// turn by 40 degrees or more, the nearest point moves there. Throws InputError if a corner has none.
std::vector<Vec3> points_at_lengths(const std::vector<Vec3>& line, const std::vector<double>& parts);

/// A section that moves along a polyline without turning about it. Along a segment it keeps its profile. At
/// the points of the line it is perpendicular to the tangents. So it keeps its shape along a circle, and legs
/// are mitered at a corner.
class MovingSection {
 public:
  /// Throws InputError as check_open_line(), and with the place if the line turns back.
  explicit MovingSection(std::vector<Vec3> line);
  /// Returns the place at point `i` of a place p beside the first point of the line.
  Vec3 place(const Vec3& p, std::size_t i) const;

 private:
  /// Three perpendicular unit vectors.
  struct Frame {
    Vec3 along, first, second;
  };
  std::vector<Vec3> line_, tangents_;
  std::vector<Frame> frames_;  ///< by segment, each turned from the previous one by the least turn
};

}  // namespace delquad
