#pragma once

#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "delquad/fields.h"
#include "delquad/metrics.h"
#include "fields/tangent_metric.h"
#include "geometry/mesh/half_edges.h"

namespace delquad {

/// The metric at a place of a region; `hint`: as in SizeField::at.
using MetricAt = std::function<TangentMetric(int region, const Vec3& x, int& hint)>;

/// What is measured of meshes by a metric, where there is one.
const std::vector<Metric>& metrics_by_metric();
/// eta of each quad, where the metric is the mean of those at its corners.
std::vector<double> metric_etas(const Mesh& mesh, const MetricAt& metric);
std::map<std::string, double> measure_by_metric(const Mesh& mesh, std::span<const HalfEdge> sides,
                                                const MetricAt& metric);

}  // namespace delquad
