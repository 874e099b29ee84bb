#pragma once

#include <filesystem>

#include "delquad/hexahedra.h"

namespace delquad {

/// As write_msh() does: volumes, faces and curves are entities of dimension 3, 2 and 1, each in one physical
/// group.
void write_hex_msh(const std::filesystem::path& path, const HexMesh& mesh, bool binary);
/// Hexahedra first, then quads and lines, with the numbers of their volumes, faces and curves (arrays
/// `volume`, `face`, `curve`; 0: none) and of hexahedra the least scaled Jacobian.
void write_hex_vtu(const std::filesystem::path& path, const HexMesh& mesh);
/// C3D8. Every name of volumes is an ELSET and an NSET, of faces an NSET and, on the boundary, a SURFACE, of
/// curves an NSET.
void write_hex_inp(const std::filesystem::path& path, const HexMesh& mesh);

/// InputError when write_hexahedra() knows no format for the path's extension, naming those known.
void check_hex_format(const std::filesystem::path& path, bool binary);

}  // namespace delquad
