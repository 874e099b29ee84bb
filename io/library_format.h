// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "delquad/mesh.h"
#include "io/mesh_io.h"

// This header has formats whose libraries are loaded on demand. The tables of formats use it.

namespace delquad {

/// A mesh format that a library of another project reads or writes. Its code is in libdelquad-<name>, which
/// the first file of this format loads.
struct LibraryFormat {
  Mesh (*read)(const std::filesystem::path&, ReadNotes*, Strays) = nullptr;  ///< null: it is not read
  void (*write)(const std::filesystem::path&, const Mesh&) = nullptr;
};

}  // namespace delquad
