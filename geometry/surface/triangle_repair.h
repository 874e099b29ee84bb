// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <string>
#include <vector>

#include "base/warning.h"
#include "delquad/mesh.h"

// This header repairs triangulations from files. Features and geometry use it.

namespace delquad {

/// Returns a surface from triangles of a file (own method). Each edge is in one triangle, in two that agree
/// in orientation, or in more, where the surface branches. Each vertex is in one fan, each line on an edge.
/// There are no quads, no triangle without area, none twice, no unused point. Each kind of repair adds a line
/// to `warnings`:
/// - ends of open edges within `weld_tolerance` (a length) become one point. If others are nearly as close, a
///   warning tells a tolerance that closes the gaps;
/// - the first of several triangles on the same vertices stays;
/// - triangles without area are removed without gaps (take_out_flat_triangles());
/// - the first of several flat parts with the same outline of branching edges stays;
/// - triangles that disagree with their neighbors are reversed, the fewer in each component. Closed
///   components face outwards, unless they lie in the bounding box of the largest one and may be cavities. If
///   neighbors cannot agree, sharp edges between them stay as joints of sheets;
/// - a vertex where fans touch becomes one vertex for each fan;
/// - lines that are not edges are removed. Throws InputError, beginning with `source`, for coordinates that
///   are not finite, stray points, quads, and a mesh without triangles. It also throws for more branching
///   edges than edges between two triangles, and for a surface that cannot be oriented.
Mesh repair_triangles(Mesh mesh, double weld_tolerance, const std::string& source,
                      std::vector<Warning>& warnings);

/// Repairs orientation, lines, and vertices where fans touch, whose copies come last. Triangles and points
/// stay in their order. Each triangle must have an area. Throws InputError as repair_triangles() for
/// orientation.
void settle_triangles(Mesh& mesh, const std::string& source, std::vector<Warning>& warnings);

/// Returns whether the triangle's height exceeds 1e-12 of its longest side, which is the rounding of
/// collinear points.
bool has_area(const std::vector<Vec3>& points, const std::array<int, 3>& v);

/// Number of removed triangles, and a vertex of the first.
struct FlatTriangles {
  int count = 0;
  Vec3 first;
};

/// Removes the triangles without area so that no gap opens. The ends of a side without length become one
/// vertex. If a triangle has its third vertex between the others, all triangles on its longest side are cut
/// there. The parity of triangles at each edge does not change, so closed parts stay closed. If triangles
/// coincide, two are removed. Lines on cut sides are cut, too. The method is own. `count` is the number of
/// given triangles. Throws InputError, beginning with `source`, if flat triangles are so tangled that the
/// removal does not end.
FlatTriangles take_out_flat_triangles(Mesh& mesh, const std::string& source);

/// Reverses triangles so that neighbors agree, by the majority in each component; closed components face
/// outwards, see repair_triangles(). If neighbors cannot agree, they are separated at sharp edges if they
/// `may_part`. Otherwise throws InputError.
void orient_triangles(Mesh& mesh, const std::string& source, std::vector<Warning>& warnings,
                      bool may_part = false);

}  // namespace delquad
