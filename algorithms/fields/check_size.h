// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "delquad/error.h"
#include "delquad/mesh.h"

namespace delquad {

/// Finite and positive.
bool is_size(double delta);

/// "`field` is -0.2 at (0.8, 0, 0); a size must be finite and positive"
InputError bad_size(const std::string& field, const Vec3& x, double delta);

}  // namespace delquad
