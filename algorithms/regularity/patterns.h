#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "algorithms/regularity/polygon_sides.h"
#include "delquad/mesh.h"

namespace delquad {

/// The rim of a cavity counterclockwise, beginning anywhere.
struct Outline {
  std::vector<Vec2> places;
  std::vector<double> delta;  ///< wanted length of edges
  std::vector<int> turn;  ///< 2 - (quads that the vertex gets inside): 1 a corner, 0 on a side, -1 concave
};

/// A mesh of a polygon with few irregular vertices. Those of its rim get as many quads as they want, and
/// those inside have four, but for a few of three or five. By its corners N, with no concave vertex:
///
///   N = 4, opposite sides alike: none, a grid            N = 3: one of three     N = 5: one of five
///   N = 4 otherwise: one of three, one of five           N = 2: two of three     N > 5: N - 4 of five
///
/// A single irregular vertex (star) has its place by the sides' lengths. That may be on a side: one of five
/// is a vertex of the rim then that gets a quad more than it wants. Otherwise a vertex T of three quads is
/// the far corner of a grid in one of the polygon's corners, and what is left is a polygon of one corner
/// more, in which T is no corner; or a row of edges cuts the polygon in two: a pentagon off one of six or
/// more corners, or from a concave vertex. The parts may be cut further. All but stars leave a choice.
struct Pattern {
  enum Kind { kGrid, kStar, kCorner, kCut };
  Kind kind = kGrid;
  int at = 0;     ///< kCorner: the side that begins at the corner; kCut: place on the outline where it begins
  int along = 0;  ///< kCorner: edges of the grid on side `at`; kCut: quads at `at` in the first part
  int back = 0;   ///< kCorner: edges of the grid on the side before; kCut: quads at its end in the first part
  int to = 0;     ///< kCut: place where it ends
  int cut = 0;    ///< kCut: its edges
  std::vector<Vec2> places = {};    ///< of the irregular vertices, T first
  std::vector<Pattern> parts = {};  ///< kCut: from its start around to its end, and the other
  double strain = 0;                ///< sum over its lines of (edges) * log^2(length / wanted length)
};

/// How many irregular vertices a pattern has.
int irregular_vertices(const Pattern& pattern);

/// Of the patterns with at most so many irregular vertices that with the fewest, of these the one with the
/// least strain; `most` makes no other difference. Of cuts only those with the least strain of their own are
/// tried.
std::optional<Pattern> best_pattern(const Outline& outline, int most);

struct PatternMesh {
  std::vector<Vec2> inside;               ///< vertices after those of the rim
  std::vector<std::array<int, 4>> quads;  ///< counterclockwise
};

/// Lines between irregular vertices and the rim are straight, and blocks between lines are Coons patches.
PatternMesh mesh_pattern(const Outline& outline, const Pattern& pattern);

/// Of a row of edges between two places: (edges) * log^2(length / wanted length).
double strain_of(Vec2 a, Vec2 b, int edges, double delta);

/// Of the patterns without cuts of an outline without concave vertices the one with the least strain.
std::optional<Pattern> best_convex(const Outline& outline, const PolygonSides& sides);

}  // namespace delquad
