// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "delquad/mesh.h"

// This header refuses meshes that functions cannot handle. Entries of the public API use it.

namespace delquad {

/// Throws InputError, which begins with `where`, for indices out of range, lists of different lengths, and
/// coordinates that are not finite. For other defects see check_invariants().
void require_readable(const Mesh& mesh, const std::string& where);

/// Throws InputError, which begins with `where`, for cells of volumes and for elements of a higher order.
void require_straight(const Mesh& mesh, const std::string& where);

}  // namespace delquad
