// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "algorithms/fields/size_aware_cross_field.h"
#include "algorithms/fields/surface/surface_metric.h"
#include "geometry/patches/meshing_setup.h"
#include "metrics/anisotropic_measures.h"

// This header has metrics of surfaces. The preparation uses it. Lengths of sides in the metric flatten charts
// and divide curves. All else happens in the flat patches, whose size is the size of the metric.

namespace delquad {

/// Returns the metric of a model as it was read; lengths are smaller at the spots.
WantedMetric wanted_metric(const MeshProblem& problem, const SurfaceModel& model,
                           const std::vector<SizeBall>& spots);

/// Runs flatten() by lengths in a metric.
Flattening flatten_by_metric(SurfaceModel& model, const SurfaceMetric& metric);

/// Returns the pull of the field of a patch to the axes of the metric.
CrossPull pull_at(const SurfaceSetup& surface, int patch, Vec2 u, int& hint);

/// Returns the factor between lengths of the plane and of the metric: below 1 if the mesh must be finer.
double scale_of(const MeshingSetup& prepared);

/// Returns the metric by which meshes are measured; null: none.
MetricAt metric_of(const MeshingSetup& prepared);

}  // namespace delquad
