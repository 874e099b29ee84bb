// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "delquad/metrics.h"
#include "geometry/surface/chart.h"

namespace delquad {

struct ConformalMap {
  std::vector<Vec2> flat;
  FlatQuality quality;
  std::string method;
};

/// Scaled to the chart's area; none when it is not one-to-one.
std::optional<ConformalMap> checked_map(const Chart& chart, std::vector<Vec2> flat, const char* method);

/// The chart as it lies in its plane; none when a point is further than `tolerance` (length) from the plane
/// or triangles look to different sides. Where a line has the chart on both sides, these are moved apart by
/// 1e-4 of its length: the map of a slit is one-to-one, too.
std::optional<std::vector<Vec2>> planar_map(const Chart& chart, double tolerance);

/// Boundary-first flattening of a disk with the boundary's lengths kept: the Poisson problem for the
/// logarithm of the scale tells how much each boundary vertex turns, the curve so defined is closed by the
/// least change of lengths, and extended inwards by harmonic coordinates [sawhney2017].
/// Exact on developable charts.
std::vector<Vec2> boundary_first_map(const Chart& chart);

/// The same into a convex polygon, whose corners are those of the chart as far as they turn enough, by the
/// scale whose flux is the difference of the turns: one-to-one wherever the triangles resolve it, for sides
/// of a convex polygon never meet. Its scale varies more.
std::vector<Vec2> convex_map(const Chart& chart);

/// The map of least conformal energy for a given extent of the boundary: an eigenvector, so no vertex is
/// pinned [mullen2008]. Any number of loops, at least one.
std::vector<Vec2> spectral_map(const Chart& chart);

}  // namespace delquad
