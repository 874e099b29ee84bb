// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "delquad/mesh.h"
#include "io/mesh_io.h"

// This header reads and writes VTU files. Fields, experiments and the tables of formats use it.

namespace delquad {

/// Reads VTK XML of an unstructured grid: lines, triangles and quads. Arrays are text or base64, inline or
/// appended (also raw), plain or compressed by zlib. Curves, regions and names are read as write_vtu() writes
/// them; files of other programs have one curve and one region. Throws InputError with the file.
Mesh read_vtu(const std::filesystem::path& path);
/// Writes VTK XML (base64). Cells are lines, triangles, quads; or hexahedra, quads, lines. Arrays of tags
/// have the curve and the region of each cell, or the volume, face and curve beside hexahedra (0: none). Each
/// field in `cell_data` has a value for each cell. Lines have no values of `fields` (NaN). Names are field
/// data: an array "curve NAME" or "region NAME" lists the tags. A known unit of lengths is a comment, as in
/// OBJ, Abaqus input and Medit text. Throws InputError as write_mesh().
void write_vtu(const std::filesystem::path& path, const Mesh& mesh,
               const std::map<std::string, std::vector<double>>& cell_data = {},
               const std::vector<MeshField>& fields = {});
}  // namespace delquad
