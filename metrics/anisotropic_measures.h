// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "algorithms/fields/tangent_metric.h"
#include "delquad/fields.h"
#include "delquad/metrics.h"
#include "geometry/mesh/half_edges.h"

// This header measures meshes in their metric. The program, experiments and metrics use it.

namespace delquad {

/// Returns the metric at a place of a region; `hint` is as in SizeField::at.
using MetricAt = std::function<TangentMetric(int region, const Vec3& x, int& hint)>;

/// Returns the measures of a mesh in its metric.
const std::vector<Metric>& anisotropic_measures();
/// Returns eta of each quad, 0 to 1, in the mean metric [arsigny2006] of its corners.
std::vector<double> anisotropic_etas(const Mesh& mesh, const MetricAt& metric);
/// Returns the values of these measures by key. `sides` is sorted_half_edges() of the mesh.
std::map<std::string, double> measure_anisotropic(const Mesh& mesh, std::span<const HalfEdge> sides,
                                                  const MetricAt& metric);

}  // namespace delquad
