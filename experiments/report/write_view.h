// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "delquad/mesh.h"

// This header writes the page of a mesh. The program and the Python module use it.

namespace delquad {

/// Further data on a mesh.
struct ViewNotes {
  std::vector<std::string> warnings = {};
  std::vector<std::size_t> failing = {};  ///< quads beyond criteria, which have a color of their own
};

/// Writes one HTML file that shows a mesh: shape, sizes, names that are switched on and off, worst quads.
/// Faces of hexahedra have the color of the least scaled Jacobian at them. If
/// a mesh has more than 1.7 million quads, the page shows some elements, and says so. The file is written
/// whole or not at all. Throws InputError for a mesh without triangles, quads and lines, and for a file that
/// cannot be written.
void write_view(const std::filesystem::path& file, const Mesh& mesh, const std::string& title,
                const ViewNotes& notes = {});

}  // namespace delquad
