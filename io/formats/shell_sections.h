// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "delquad/mesh.h"

// This header has sections of shells. Formats of decks carry them from one to another.

namespace delquad {

/// An isotropic material in the units of the deck; density 0: none.
struct ShellMaterial {
  std::string name;
  double young = 0, poisson = 0, density = 0;
  bool operator==(const ShellMaterial&) const = default;
};

/// Homogeneous shells of a deck: a thickness and a material for regions of its mesh.
struct ShellSections {
  struct Section {
    std::vector<int> regions;  ///< indices into Mesh::regions
    double thickness;
    std::string material;
  };
  std::vector<ShellMaterial> materials;  ///< each once
  std::vector<Section> sections;
  std::map<std::string, int> carried;  ///< keywords that these replace, with counts; see MeshFormat::others
  std::vector<std::string> lost;       ///< sections and fields that get lost, with the reason
};

/// Reads *SHELL SECTION with *ELASTIC and *DENSITY of its *MATERIAL. Throws InputError as read_inp_deck().
ShellSections inp_sections(const std::filesystem::path& path);
/// Reads PSHELL and MAT1. Throws InputError as read_nastran_deck().
ShellSections nastran_sections(const std::filesystem::path& path);

/// Adds sections to a file that the writer of the format made of the mesh. `lost` gets the parts without a
/// place there.
void add_inp_sections(const std::filesystem::path& path, const Mesh& mesh, ShellSections& sections);
void add_nastran_sections(const std::filesystem::path& path, const Mesh& mesh, ShellSections& sections);

}  // namespace delquad
