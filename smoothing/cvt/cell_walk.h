// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "smoothing/cvt/bounded_voronoi.h"
#include "smoothing/cvt/moving_delaunay.h"

// This header walks around cells of the bounded Voronoi diagram. The Lp energy uses it.

namespace delquad {

/// End of an edge between two cells of a bounded Voronoi diagram.
struct CellEnd {
  enum Kind {
    kOutside,  ///< the edge lies outside the patch
    kCentre,   ///< index: corner 3 t + k of the triangle with this circumcenter
    kClip,     ///< index of the clip
    kMiddle    ///< middle of a boundary edge; it does not move
  };
  Kind kind = kOutside;
  int index = -1;
  Vec2 at;
};

/// Calls edge(first, second), with CellEnds, for each edge between the cell of a seed and another cell,
/// counterclockwise. At a boundary seed, edges also end in the middles of its boundary edges. The triangles
/// (seed, first, second) and the pieces of the boundary in the cell make up the cell.
template <class Edge>
void walk_cell(const MovingDelaunay& delaunay, const BoundedVoronoi& cells, int seed, Edge edge) {
  const TriPatch& tri = delaunay.patch();
  const Vec2 x = tri.points[seed];
  const bool on_boundary = seed < tri.n_boundary;
  // Returns the end in triangle t (corner k is the seed) of the edge dual to side m.
  const auto end_in = [&](int t, int k, int m) -> CellEnd {
    if (!cells.is_blind(t)) return {CellEnd::kCentre, 3 * t + k, cells.centres()[t]};
    const int clip = cells.clip_of(t, m);
    if (clip == BoundedVoronoi::kOutside) return {};
    return {CellEnd::kClip, clip, cells.clips()[clip].at};
  };
  const auto middle = [&](int other) -> CellEnd {
    return {CellEnd::kMiddle, -1, 0.5 * (x + tri.points[other])};
  };
  const auto visit = [&](const CellEnd& first, const CellEnd& second) {
    if (first.kind != CellEnd::kOutside && second.kind != CellEnd::kOutside) edge(first, second);
  };

  CellEnd before, first_of_all;
  int last_triangle = -1, last_corner = -1;
  for_each_corner(delaunay, seed, [&](int t, int k) {
    const CellEnd here = end_in(t, k, kLastCorner[k]);
    if (last_triangle >= 0)
      visit(before, here);
    else if (on_boundary)
      visit(middle(tri.triangles[t][kNextCorner[k]]), here);
    else
      first_of_all = here;
    before = end_in(t, k, kNextCorner[k]);
    last_triangle = t;
    last_corner = k;
  });
  if (on_boundary)
    visit(before, middle(tri.triangles[last_triangle][kLastCorner[last_corner]]));
  else
    visit(before, first_of_all);
}

}  // namespace delquad
