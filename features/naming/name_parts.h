// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "delquad/model.h"
#include "geometry/surface/surface_model.h"

// This header gives names to faces and curves. The input of surfaces uses it.

namespace delquad {

/// Gives faces and curves the names that are asked for, beside those that they have, in the order of the
/// list: a part that is named first can be found by its name later. Throws InputError for a part that nothing
/// fits, and for numbers that no face or curve has. So it does where two are as near to a place as each
/// other.
void name_parts(const std::vector<NamedPart>& parts, SurfaceModel& model);

/// Returns the faces that any of the rules selects, ascending. Throws InputError, beginning with `where`, for
/// a rule that no face fits.
std::vector<int> selected_faces(const std::vector<PartRule>& rules, const std::string& where,
                                const Mesh& fine);

}  // namespace delquad
