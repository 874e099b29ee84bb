// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "delquad/metrics.h"
#include "geometry/surface/chart.h"

// This header maps charts to the plane. Flattening and metrics use it.

namespace delquad {

struct ConformalMap {
  std::vector<Vec2> flat;
  FlatQuality quality;
  std::string method;
};

/// Returns the map scaled to the chart's area; none when it is not one-to-one.
std::optional<ConformalMap> checked_map(const Chart& chart, std::vector<Vec2> flat, const char* method);

/// Returns the chart as it lies in its plane. None if a point is further than `tolerance` (length) from the
/// plane or triangles look to different sides. Where a line has the chart on both sides, these are moved
/// apart by 1e-4 of its length. The map of a slit is one-to-one, too.
std::optional<std::vector<Vec2>> planar_map(const Chart& chart, double tolerance);

/// Makes the boundary-first flattening of a disk with the boundary's lengths kept [sawhney2017]. The Poisson
/// problem for the logarithm of the scale tells how much each boundary vertex turns. The curve so defined is
/// closed by the least change of lengths, and extended inwards by harmonic coordinates. Exact on developable
/// charts.
std::vector<Vec2> boundary_first_map(const Chart& chart);

/// Returns the same into a convex polygon, by the scale whose flux is the difference of the turns. Its
/// corners are the corners of the chart as far as they turn enough. It is one-to-one wherever the triangles
/// resolve it, for sides of a convex polygon never meet. Its scale varies more.
std::vector<Vec2> convex_map(const Chart& chart);

/// Returns the map of least conformal energy for a given extent of the boundary: an eigenvector, so no vertex
/// is pinned [mullen2008]. Any number of loops, at least one.
std::vector<Vec2> spectral_map(const Chart& chart);

}  // namespace delquad
