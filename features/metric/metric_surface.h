// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "algorithms/fields/size_aware_cross_field.h"
#include "algorithms/fields/surface/surface_metric.h"
#include "geometry/patches/meshing_setup.h"
#include "metrics/anisotropic_measures.h"

// This header has metrics of surfaces, which the preparation uses. A surface with a metric is measured by it
// where it is laid flat: charts by the lengths of their sides, curves by theirs. All else happens in the flat
// patches, whose size is the metric's own.

namespace delquad {

/// Returns the metric of a model; sizes are smaller at the spots. `model`: the model as it was read.
WantedMetric wanted_metric(const MeshProblem& problem, const SurfaceModel& model,
                           const std::vector<SizeBall>& spots);

/// Runs flatten() by lengths in a metric.
Flattening flatten_by_metric(SurfaceModel& model, const SurfaceMetric& metric);

/// Returns how much the field of a patch is drawn to the metric's axes.
CrossPull pull_at(const SurfaceSetup& surface, int patch, Vec2 u, int& hint);

/// Returns by which factor lengths in a plane are larger than the metric's own: where it is told to be finer,
/// or not.
double scale_of(const MeshingSetup& prepared);

/// Returns the metric that meshes are measured by; null: none.
MetricAt metric_of(const MeshingSetup& prepared);

}  // namespace delquad
