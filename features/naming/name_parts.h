// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "delquad/model.h"
#include "geometry/surface/surface_model.h"

// This header gives names to faces and curves. The input of surfaces uses it.

namespace delquad {

/// Gives faces and curves further names, in the order of the list, so that an entry may use names of earlier
/// ones. Throws InputError for an entry that no part fits, for unknown numbers, and for two parts equally
/// near to a place.
void name_parts(const std::vector<NamedPart>& parts, SurfaceModel& model);

/// Returns the faces that any of the rules selects, ascending. Throws InputError, beginning with `where`, for
/// a rule that no face fits.
std::vector<int> selected_faces(const std::vector<PartRule>& rules, const std::string& where,
                                const Mesh& fine);

}  // namespace delquad
