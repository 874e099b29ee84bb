// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "geometry/surface/chart.h"

// This header has paths across charts, along which they are cut. Geometry uses it.

namespace delquad {

/// A point on a vertex (b < 0) or inside an edge of a triangulation: (1 - t) a + t b.
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

Vec3 position(const Chart& chart, const EdgePoint& point);

/// Returns the path with its length. None when it is no more than one side of the boundary, or visits a
/// vertex or an edge twice.
std::optional<CutPath> measured(const Chart& chart, CutPath path);

/// A connected piece of a level curve.
struct LevelCurve {
  CutPath path;  ///< moved into vertices that are near
  std::vector<std::pair<int, int>>
      crossed;  ///< edges that the curve itself crosses, as (lower, higher), sorted
};

/// Returns the connected pieces of the curve u = level. Pieces that touch the boundary other than with their
/// ends, or themselves, are left out.
std::vector<LevelCurve> level_curves(const Chart& chart, const std::vector<double>& u, double level);

/// Returns the path of steepest descent of u, linear on triangles, from a vertex to the first vertex or
/// boundary side that is reached. A target may also be an inner vertex. None when it ends in a minimum
/// elsewhere.
std::optional<CutPath> descend(const Chart& chart, const std::vector<std::vector<int>>& around,
                               const std::vector<double>& u, int start, const std::vector<char>& target);

}  // namespace delquad
