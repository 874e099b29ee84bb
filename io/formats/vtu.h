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

/// Reads VTK XML of an unstructured grid: lines, triangles, quads and cells of volumes. Arrays are text or
/// base64, inline or appended (raw, too), plain or compressed by zlib. Curves, regions and names are as
/// write_vtu() writes them; files of other programs have one curve and one region.
Mesh read_vtu(const std::filesystem::path& path, ReadNotes* notes = nullptr);
/// Writes VTK XML (base64). Cells are lines, then triangles, then quads; with cells of volumes they are
/// these, then faces, then lines. Arrays of tags tell the curve and the region of each cell, or the volume,
/// face and curve beside cells (0: none). A cell has one value for each field in `cell_data`. Lines have no
/// values of `fields` (NaN). Names are field data: an array "curve NAME" or "region NAME" lists the tags. A
/// known unit of lengths is a comment, here and in OBJ, Abaqus input and Medit text.
void write_vtu(const std::filesystem::path& path, const Mesh& mesh,
               const std::map<std::string, std::vector<double>>& cell_data = {},
               const std::vector<MeshField>& fields = {});
}  // namespace delquad
