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

/// Returns the built-in measures of a mesh; `sides` is its sorted_half_edges(). `size` and `given` are as in
/// evaluate_metrics(). Quads with `in_layers` are flat on purpose, and left out of measures by size; empty:
/// none.
MeshMetrics measure_builtin(const Mesh& mesh, const SizeField* size, const SizeField* given,
                            std::span<const HalfEdge> sides, const std::vector<char>& in_layers = {});
/// Adds the added measures; an exception of one becomes a reason in MeshMetrics::failures.
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
