// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "delquad/metrics.h"
#include "geometry/surface/surface_model.h"

// This header describes a surface model. `info`, warnings and the pipeline use it.

namespace delquad {

/// Throws InputError as extract_charts() does.
ModelReport report_model(const SurfaceModel& model);

/// Returns "disk", "annulus", "disk with 3 holes", "closed", "2 handles, 1 loop": what a map of the face has
/// to cope with.
std::string topology(const FaceReport& face);

/// Adds warnings that tell of the curves with a face on one side only, and of those with more than two faces.
void report_edges(SurfaceModel& model);

}  // namespace delquad
