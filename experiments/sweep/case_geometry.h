// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "io/cases/case.h"
#include "metrics/tables/study_file.h"

// This header tells geometries of cases apart. Descriptions of experiments use it.

namespace delquad {

/// Returns the identity of the geometry of a case. CAD files have a digest of their bytes, without the header
/// of STEP. Outlines and meshes have moments, which do not depend on place, turn, mirror image, scale, and
/// division into edges and flat elements. With them comes the possible error of chords. An unreadable file
/// has neither.
CaseGeometry geometry_of(const Case& c);

}  // namespace delquad
