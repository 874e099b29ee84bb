// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "geometry/surface/chart.h"

// This header has paths across charts, along which they are cut. Geometry uses it.

namespace delquad {

/// A point on vertex a (b < 0), or inside an edge of a triangulation: (1 - t) a + t b with 0 < t < 1.
struct EdgePoint {
  int a = -1, b = -1;
  double t = 0;
  friend bool operator==(const EdgePoint&, const EdgePoint&) = default;
};

/// A path across a chart, straight in each triangle: consecutive points lie on one triangle, and no vertex or
/// edge is visited twice. Open paths begin and end on the boundary or at an inner vertex.
struct CutPath {
  std::vector<EdgePoint> points;
  bool closed = false;
  double length = 0;
};

/// Returns the place of a point in space.
Vec3 position(const Chart& chart, const EdgePoint& point);

/// Returns the path with its length. Nothing if it is only a side of the boundary, or visits a vertex or an
/// edge twice.
std::optional<CutPath> measured(const Chart& chart, CutPath path);

/// A connected piece of a level curve.
struct LevelCurve {
  CutPath path;  ///< path, moved into near vertices
  std::vector<std::pair<int, int>>
      crossed;  ///< edges that the level curve crosses, as (lower, higher), sorted
};

/// Returns the connected pieces of the curve u = level, without pieces that touch themselves, or the boundary
/// except with their ends.
std::vector<LevelCurve> level_curves(const Chart& chart, const std::vector<double>& u, double level);

/// Returns the path of steepest descent of u, linear on triangles, from a vertex to the first target vertex,
/// or the boundary between two. Nothing if it ends in a minimum elsewhere. `around` has triangles_around().
std::optional<CutPath> descend(const Chart& chart, const std::vector<std::vector<int>>& around,
                               const std::vector<double>& u, int start, const std::vector<char>& target);

}  // namespace delquad
