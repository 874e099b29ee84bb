// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "delquad/mesh.h"

// This header has readers with a file of their own. The tables of formats use it.

namespace delquad {

/// Reads Medit text: references are tags of curves and regions, and comments of write_medit() give names. A
/// file of MFEM is read as such. Throws InputError with file and line.
Mesh read_medit(const std::filesystem::path& path);
/// Reads MFEM meshes v1.0 of dimension 2. Attributes are tags, and comments of write_mfem() give names.
/// Curved meshes consist of quads, with nodes of H1 or closed L2 elements up to kMostOrder. Throws
/// InputError, with file and line, also if shared nodes differ in place.
Mesh read_mfem(const std::filesystem::path& path);

}  // namespace delquad
