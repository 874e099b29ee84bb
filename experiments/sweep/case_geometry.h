// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "io/cases/case.h"
#include "metrics/tables/study_file.h"

// This header tells geometries of cases apart. Descriptions of experiments use it.

namespace delquad {

/// Tells the geometry of a case from others. CAD files have a digest of their bytes, without the header of
/// STEP. Outlines and meshes have moments. These stay the same wherever the shape lies, however it is turned,
/// mirrored, scaled or divided into edges and flat elements. With them comes how far chords may have changed
/// them. A file that cannot be read has neither.
CaseGeometry geometry_of(const Case& c);

}  // namespace delquad
