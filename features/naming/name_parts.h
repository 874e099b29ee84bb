// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "delquad/model.h"
#include "geometry/surface/surface_model.h"

namespace delquad {

/// Gives faces and curves the names that are asked for, beside those that they have, in the order of the
/// list: what is named first can be found by its name later. Throws InputError for a part that nothing fits,
/// for numbers that no face or curve has, and where two are as near to a place as each other.
void name_parts(const std::vector<NamedPart>& parts, SurfaceModel& model);

}  // namespace delquad
