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

/// Reads MSH 2.2 or 4.1, text or binary, by content. Elements become lines, triangles, quads and hexahedra,
/// curved ones of one order; hexahedra keep their corners. Physical names and entity tags are kept (a group
/// without a name goes by its number), and so are the further names that write_msh() leaves. Points are
/// ignored, and so are nodes that no other element uses. `notes` tells of periodic pairs, which are not read.
/// Throws InputError with file and line, or byte.
Mesh read_msh(const std::filesystem::path& path, DeclaredSurfaces* surfaces = nullptr,
              ReadNotes* notes = nullptr);
/// Writes MSH 4.1 with $PhysicalNames and $Entities, volumes with dimension 3. Coordinates read back exactly.
/// Each entity is in exactly one physical group, for meshio, dolfinx and deal.II take no other files: the
/// group of group_names(). Names beside it follow the elements in a section $MoreNames, which other programs
/// skip. A group whose name is a number gets that number as its tag. The unit of lengths, where it is known,
/// is a section $Unit after these.
void write_msh(const std::filesystem::path& path, const Mesh& mesh, const MshOptions& options = {});
/// Writes a mesh whose `fields` become views ($NodeData, $ElementData).
void write_msh(std::ostream& stream, const Mesh& mesh, const MshOptions& options = {},
               const std::vector<MeshField>& fields = {});
}  // namespace delquad
