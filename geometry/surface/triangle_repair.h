// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <string>
#include <vector>

#include "base/warning.h"
#include "delquad/mesh.h"

// This header repairs triangulations from files. Features and geometry use it.

namespace delquad {

/// Makes a surface of triangles as files hold them. Each edge is in one triangle, in two that agree in
/// orientation, or in more, where the surface branches. Each vertex is in one fan, each line on an edge.
/// There are no quads, no triangle without area, none twice, no unused point. Each kind of repair adds a line
/// to `warnings`:
/// - ends of open edges within `weld_tolerance` (a length) become one point. Where others are nearly so, a
///   warning tells the tolerance that closes the gaps, if one does;
/// - small folds go: pairs of triangles back to back, with others on some sides and none on others;
/// - of triangles on the same vertices the first stays;
/// - triangles without area go, and no gap opens (take_out_flat_triangles);
/// - flat parts between branching edges that have the same outline are one place: the first stays;
/// - triangles that run against their neighbors are turned, the fewer in each component. A closed component
///   is turned outwards, unless it lies in the bounding box of the largest one and may be a cavity. Where
///   neighbors cannot agree, sharp edges between them stay as joints of sheets;
/// - a vertex where fans touch becomes one vertex a fan;
/// - lines that are not edges go. Throws InputError, beginning with `source`, for coordinates that are not
///   finite, stray points, quads and no triangles. So it does for more branches than edges between two
///   triangles, and a surface that cannot be oriented.
Mesh repair_triangles(Mesh mesh, double weld_tolerance, const std::string& source,
                      std::vector<Warning>& warnings);

/// Makes the repairs of orientation, of lines, and of vertices where fans touch, whose copies come last:
/// triangles and points stay, and their order. Each edge must be in one triangle or more, none of them
/// without area.
void settle_triangles(Mesh& mesh, const std::string& source, std::vector<Warning>& warnings);

/// Returns whether the triangle's height is more than what rounding leaves of collinear points (1e-12 of its
/// longest side).
bool has_area(const std::vector<Vec3>& points, const std::array<int, 3>& v);

/// Triangles that were taken out, and a vertex of the first.
struct FlatTriangles {
  int count = 0;
  Vec3 first;
};

/// Removes the triangles without area so that no gap opens. The ends of a side without length become one
/// vertex. If a triangle has its third vertex between the others, all triangles on its longest side are cut
/// there. Afterwards its boundary is zero modulo two. So each edge stays in an even or an odd number of
/// triangles, and closed parts stay closed. If triangles come to lie on the same vertices, two are removed.
/// Lines on cut sides are cut, too. `count`: number of given triangles. Throws InputError, beginning with
/// `source`, if such triangles lie on each other in so many ways that there is no end.
FlatTriangles take_out_flat_triangles(Mesh& mesh, const std::string& source);

/// Turns triangles so that neighbors agree, each component as most of its triangles run, closed ones
/// outwards; see repair_triangles. Where neighbors cannot agree, InputError, or, if they `may_part`, they
/// stay apart at sharp edges.
void orient_triangles(Mesh& mesh, const std::string& source, std::vector<Warning>& warnings,
                      bool may_part = false);

}  // namespace delquad
