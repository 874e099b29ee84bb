#pragma once

#include <deque>
#include <functional>
#include <span>

#include "delquad/metrics.h"
#include "mesh/half_edges.h"

namespace delquad {

/// evaluate_metrics() with the mesh's sorted_half_edges().
MeshMetrics evaluate_metrics(const Mesh& mesh, const SizeField* size, const SizeField* given,
                             const Options& options, std::span<const HalfEdge> sides);

/// The measures from outside, with their keys.
struct OwnMetric {
  std::string key;
  std::function<double(const MetricInput&)> measure;
};
const std::deque<OwnMetric>& own_metrics();

}  // namespace delquad
