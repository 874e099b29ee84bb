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

/// Returns the map scaled to the chart's area; nothing if it is not one-to-one.
std::optional<ConformalMap> checked_map(const Chart& chart, std::vector<Vec2> flat, const char* method);

/// Returns the chart in its plane. Nothing if a point is further than `tolerance` (a length) from the plane,
/// or triangles have opposite normals. Both sides of a slit are moved apart by 1e-4 of its length, so that
/// the map is one-to-one.
std::optional<std::vector<Vec2>> planar_map(const Chart& chart, double tolerance);

/// Returns the boundary-first flattening of a disk with the boundary's lengths [sawhney2017]. The Poisson
/// problem for the logarithm of the scale tells how much each boundary vertex turns. The curve so defined is
/// closed by the least change of lengths, and extended inwards by harmonic coordinates. Exact on developable
/// charts.
std::vector<Vec2> boundary_first_map(const Chart& chart);

/// Returns the same into a convex polygon, by the scale whose flux is the difference of the turns
/// [sawhney2017]. Its corners are corners of the chart that turn by 30 degrees or more. It is one-to-one if
/// triangles resolve it, since sides of a convex polygon never meet, but its scale varies more.
std::vector<Vec2> convex_map(const Chart& chart);

/// Returns the map of least conformal energy for a given extent of the boundary, by an eigenvector
/// [mullen2008]. The chart has at least one loop.
std::vector<Vec2> spectral_map(const Chart& chart);

}  // namespace delquad
