// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <ostream>
#include <vector>

#include "delquad/mesh.h"
#include "delquad/model.h"
#include "io/mesh_io.h"

// This header reads and writes MSH files. Other formats, cases and experiments use it.

namespace delquad {

/// Reads MSH 2.2 or 4.1, text or binary, by content. Elements of dimension 1 and 2 become lines, triangles
/// and quads, curved ones of one order. Physical names, entity tags and the further names of write_msh() are
/// kept; a group without a name has its number. Points are ignored, like nodes that no other element uses.
/// `notes` tells of periodic pairs, which are not read. Throws InputError with file and line, or byte.
Mesh read_msh(const std::filesystem::path& path, DeclaredSurfaces* surfaces = nullptr,
              ReadNotes* notes = nullptr);
/// Writes MSH 4.1, or 2.2 to .msh2, with $PhysicalNames and $Entities, volumes with dimension 3 [Gmsh
/// reference manual, "MSH file format"]. Coordinates read back exactly. Each entity is in exactly one
/// physical group, the group of group_names(), because meshio, dolfinx and deal.II need this. Further names
/// follow in a section $MoreNames, which other programs skip. A group whose name is a number has that number
/// as its tag. A known unit of lengths is a last section $Unit. Throws InputError as write_mesh().
void write_msh(const std::filesystem::path& path, const Mesh& mesh, const MshOptions& options = {});
/// Writes a mesh with `fields` as views ($NodeData, $ElementData).
void write_msh(std::ostream& stream, const Mesh& mesh, const MshOptions& options = {},
               const std::vector<MeshField>& fields = {}, bool is_22 = false);
}  // namespace delquad
