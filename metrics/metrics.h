// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deque>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "delquad/metrics.h"
#include "geometry/mesh/half_edges.h"

// This header measures meshes. The pipeline, experiments and formats use it.

namespace delquad {

/// Measures a mesh by the built-in measures; `sides` is its sorted_half_edges(). Quads with `in_layers` are
/// flat on purpose, and left out of measures by size. Empty: none.
MeshMetrics measure_builtin(const Mesh& mesh, const SizeField* size, const SizeField* given,
                            std::span<const HalfEdge> sides, const std::vector<char>& in_layers = {});
/// Adds the added measures.
void measure_added_metrics(const MetricInput& input, MeshMetrics& metrics);

/// Returns only the measures of shapes of elements and of valences.
MeshMetrics evaluate_shapes(const Mesh& mesh, std::span<const HalfEdge> sides);

/// An added measure with its key.
struct AddedMetric {
  std::string key;
  std::function<double(const MetricInput&)> measure;
};
const std::deque<AddedMetric>& added_metrics();

}  // namespace delquad
