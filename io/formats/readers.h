#pragma once

#include <filesystem>

#include "delquad/mesh.h"

namespace delquad {

// Readers with a file of their own beside that of the writer.

/// Reads Abaqus input: *NODE, *ELEMENT of two to four or eight nodes (shells, membranes, plane ones, bars),
/// *ELSET. Element sets become names of regions, unless their own begins with an underscore; surfaces of
/// elements' sides (S1 to S4, E1 to E4) become curves. Other keywords are left out.
Mesh read_inp(const std::filesystem::path& path);
/// Reads Medit text: references are tags of curves and regions, names are those that write_medit() leaves in
/// comments. A file that shows to be one of MFEM is read as such.
Mesh read_medit(const std::filesystem::path& path);
/// Reads MFEM meshes v1.0 of dimension 2: attributes are tags, names those that write_mfem() leaves in
/// comments. Curved ones are of quads, their nodes those of H1 or of closed L2 elements up to kMostOrder;
/// nodes that elements have in common must lie at one place.
Mesh read_mfem(const std::filesystem::path& path);
/// Reads Nastran's bulk data, in free, small and large fields: GRID, CQUAD4, CQUAD8, CTRIA3, and as lines
/// CBAR, CBEAM, CROD, CTUBE, CONROD and PLOTEL. Properties are tags, names those that write_nastran() leaves
/// in comments. Nodes must be in the basic coordinate system. Other cards are left out.
Mesh read_nastran(const std::filesystem::path& path);

}  // namespace delquad
