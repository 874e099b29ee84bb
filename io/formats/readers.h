// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "delquad/mesh.h"

// This header has readers with a file of their own. The tables of formats use it.

namespace delquad {

// Readers with a file of their own beside the file of the writer.

/// Reads Medit text: references are tags of curves and regions, names are those that write_medit() leaves in
/// comments. A file that shows to be one of MFEM is read as such.
Mesh read_medit(const std::filesystem::path& path);
/// Reads MFEM meshes v1.0 of dimension 2. Attributes are tags, and names are the names that write_mfem()
/// leaves in comments. Curved meshes are of quads, with nodes of H1 or of closed L2 elements up to
/// kMostOrder. Nodes that elements have in common must lie at one place.
Mesh read_mfem(const std::filesystem::path& path);

}  // namespace delquad
