// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "delquad/metrics.h"
#include "geometry/surface/surface_model.h"

// This header describes a surface model. `info`, warnings and the pipeline use it.

namespace delquad {

/// Returns sizes, topology and defects of a model. Throws as extract_charts().
ModelReport report_model(const SurfaceModel& model);

/// Returns the topology of a face: "disk", "annulus", "disk with 3 holes", "closed" or "2 handles, 1 loop".
std::string topology(const FaceReport& face);

/// Adds warnings of curves with one face, and of curves with more than two.
void report_edges(SurfaceModel& model);

}  // namespace delquad
