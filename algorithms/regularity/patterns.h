// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "algorithms/regularity/polygon_sides.h"
#include "delquad/mesh.h"

// This header has meshes of polygons with few irregular vertices. Stage Q and layouts use it.

namespace delquad {

/// Rim of a cavity, counterclockwise from any vertex.
struct Outline {
  std::vector<Vec2> places;
  std::vector<double> delta;  ///< wanted length of edges
  std::vector<int> turn;  ///< 2 - (quads inside, at the vertex): 1 at a corner, 0 on a side, -1 if concave
};

/// A mesh of a polygon with few irregular vertices, after the patterns of [reberol2021]; corner grids and
/// cuts are own. Rim vertices get the quads that they want, and inner vertices have four, except a few with
/// three or five. Without concave vertices, N corners give:
///
/// | N = 4, opposite sides alike: none, a grid | N = 3: one of three | N = 5: one of five |
/// | N = 4 otherwise: one of three, one of five | N = 2: two of three | N > 5: N - 4 of five |
///
/// A single irregular vertex (a star) has its place by the lengths of sides. On a side, it is a rim vertex
/// with five that gets one more quad than it wants. Otherwise a vertex T with three quads is the far corner
/// of a grid in a corner of the polygon. The rest is a polygon with one more corner, in which T is no corner.
/// Or a row of edges cuts the polygon in two. It cuts off a pentagon of six or more corners, or begins at a
/// concave vertex. The parts may be cut again. Only stars are unique.
struct Pattern {
  enum Kind { kGrid, kStar, kCorner, kCut };
  Kind kind = kGrid;
  int at = 0;     ///< kCorner: side after the corner; kCut: start on the outline
  int along = 0;  ///< kCorner: grid edges on side `at`; kCut: quads at the start in the first part
  int back = 0;   ///< kCorner: grid edges on the previous side; kCut: quads at the end in the first part
  int to = 0;     ///< kCut: end on the outline
  int cut = 0;    ///< kCut: number of edges
  std::vector<Vec2> places = {};    ///< irregular vertices, T first
  std::vector<Pattern> parts = {};  ///< kCut: the part from start around to end, then the other
  double strain = 0;                ///< sum over its lines of (edges) * log^2(length / wanted length)
};

/// Returns the number of irregular vertices of a pattern.
int irregular_vertices(const Pattern& pattern);

/// Returns the pattern with the fewest irregular vertices, at most `most`, and then the least strain; nothing
/// if there is none. `most` has no other effect. Only cuts with the least own strain are tried.
std::optional<Pattern> best_pattern(const Outline& outline, int most);

struct PatternMesh {
  std::vector<Vec2> inside;               ///< vertices after the rim
  std::vector<std::array<int, 4>> quads;  ///< counterclockwise
};

/// Returns the mesh of a pattern of this outline. Lines from irregular vertices to the rim are straight;
/// blocks between lines are Coons patches [coons1967].
PatternMesh mesh_pattern(const Outline& outline, const Pattern& pattern);

/// Returns the strain of a row of edges between two places: (edges) * log^2(length / wanted length).
double strain_of(Vec2 a, Vec2 b, int edges, double delta);

/// Returns the pattern without cuts of least strain, for an outline without concave vertices and its sides;
/// nothing if there is none.
std::optional<Pattern> best_convex(const Outline& outline, const PolygonSides& sides);

}  // namespace delquad
