#pragma once

#include <deque>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "delquad/metrics.h"
#include "geometry/mesh/half_edges.h"

namespace delquad {

/// The project's own measures, with the mesh's sorted_half_edges(). `in_layers`: by quad; those are left out
/// of what is measured against the size, since they are flat on purpose. Empty: none.
MeshMetrics own_measures(const Mesh& mesh, const SizeField* size, const SizeField* given,
                         std::span<const HalfEdge> sides, const std::vector<char>& in_layers = {});
/// Adds those from outside.
void measure_from_outside(const MetricInput& input, MeshMetrics& metrics);

/// Of these the measures of the elements' shapes and of vertices' valences alone.
MeshMetrics evaluate_shapes(const Mesh& mesh, std::span<const HalfEdge> sides);

/// The measures from outside, with their keys.
struct OwnMetric {
  std::string key;
  std::function<double(const MetricInput&)> measure;
};
const std::deque<OwnMetric>& own_metrics();

}  // namespace delquad
