// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "delquad/mesher.h"

// This header writes wanted sizes and crosses. Experiments and `mesh --fields` use it.

namespace delquad {

/// Writes the mesh with the wanted fields at its points: "size", and "cross_1" and "cross_2". These vectors
/// lie along the cross, with the wanted length. The format is MSH or VTU; throws as write_fields().
void write_wanted(const std::filesystem::path& path, const Mesh& mesh, const Prepared& prepared);

}  // namespace delquad
