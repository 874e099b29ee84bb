// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "delquad/error.h"
#include "delquad/mesh.h"

// This header checks sizes. Fields use it.

namespace delquad {

/// Returns whether a size is finite and positive.
bool is_size(double delta);

/// Returns the error "`field` is -0.2 at (0.8, 0, 0): expected a finite length > 0".
InputError bad_size(const std::string& field, const Vec3& x, double delta);

}  // namespace delquad
