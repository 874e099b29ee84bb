// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
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
  int other;  ///< the second one; -1: none
  int curve;  ///< index into Mesh::curves; -1: no line lies there
};

/// An edge that three or more quads share.
struct JointEdge {
  /// A quad at the edge, with its own copies of the ends.
  struct Branch {
    int quad;
    std::array<int, 2> ends;
    bool is_forward;  ///< whether the quad runs from the first end to the second
  };
  std::vector<Branch> branches;  ///< counterclockwise seen from the second end
};

/// The section that is swept: quads with the same orientation as their neighbors.
struct Section {
  Mesh mesh;              ///< quads, and points that they use
  std::vector<int> part;  ///< number of the edge-connected part of each quad
  int n_parts = 0;
  /// All edges on the boundary; inner edges whose line has a name, or that lie between two regions.
  std::vector<WallEdge> walls;
  std::vector<JointEdge> joints;
  std::vector<int> origin;  ///< point of the mesh for each copy of a point at a joint, after all other points

  /// Returns the point that a point is a copy of, or the point itself.
  int original(int point) const {
    const int first = static_cast<int>(mesh.points.size() - origin.size());
    return point < first ? point : origin[point - first];
  }
};

/// Returns the quads of a mesh as a section; `notes` tells the omissions. Throws InputError, with the place,
/// for meshes that extrude() refuses. At joints, each part of the surface gets its own copies of points.
/// Without `with_joints`, edges of three quads are refused.
Section make_section(const Mesh& mesh, bool with_joints, ReadNotes* notes);

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
