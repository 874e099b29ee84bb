// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "delquad/mesh.h"

// This header has sections of shells. Formats of decks carry them from one to another.

namespace delquad {

/// An isotropic material; density 0: it has none.
struct ShellMaterial {
  std::string name;
  double young = 0, poisson = 0, density = 0;
  bool operator==(const ShellMaterial&) const = default;
};

/// The homogeneous shells of a deck: a thickness and a material for some regions of its mesh.
struct ShellSections {
  struct Section {
    std::vector<int> regions;  ///< indices into Mesh::regions
    double thickness;
    std::string material;
  };
  std::vector<ShellMaterial> materials;  ///< each once
  std::vector<Section> sections;
  std::map<std::string, int> carried;  ///< keywords that these replace, and how many; see MeshFormat::others
  std::vector<std::string> lost;       ///< sections and fields, with the reason
};

/// Reads *SHELL SECTION with the *ELASTIC and *DENSITY of its *MATERIAL.
ShellSections inp_sections(const std::filesystem::path& path);
/// Reads PSHELL and MAT1.
ShellSections nastran_sections(const std::filesystem::path& path);

/// Adds sections to a file that the format's writer has made of the mesh. Notes in `lost` what has no place.
void add_inp_sections(const std::filesystem::path& path, const Mesh& mesh, ShellSections& sections);
void add_nastran_sections(const std::filesystem::path& path, const Mesh& mesh, ShellSections& sections);

}  // namespace delquad
