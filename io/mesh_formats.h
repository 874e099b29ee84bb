#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "delquad/hexahedra.h"
#include "io/mesh_io.h"

namespace delquad {

/// A kind of mesh file.
struct MeshFormat {
  std::vector<std::string> extensions;  ///< in small letters, with the dot; the usual one first
  std::string description;
  Mesh (*read)(const std::filesystem::path&, ReadNotes*, Strays);  ///< null: it is not read
  void (*write)(const std::filesystem::path&,
                const Mesh&);  ///< null: it is not written, but for MSH, which has options
  int most_order;              ///< of elements that are written
  std::string package =
      {};  ///< of Debian, whose library this program was built without; empty: it has all it needs
  void (*write_hexahedra)(const std::filesystem::path&, const HexMesh&, bool binary) = nullptr;
};

bool can_write(const MeshFormat& format);

/// In the order of the documentation.
const std::vector<MeshFormat>& mesh_formats();

}  // namespace delquad
