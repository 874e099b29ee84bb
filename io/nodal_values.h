// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "io/mesh_io.h"

// This header chooses fields of files. Readers of fields and the program use it.

namespace delquad {

/// The form of a field that a caller expects.
struct FieldForm {
  std::vector<int> n_components = {1};  ///< one of these
  bool of_points = false;               ///< not of elements
};

/// Returns the index of the field `name`, the last one of several; of the only name that there is where
/// `name` is empty. Throws InputError where there is none, or where it has another form.
std::size_t choose_field(const std::vector<MeshField>& fields, const std::string& name,
                         const std::string& file, const FieldForm& form);

/// Which fields of a file are read, by what it says of them before their values.
using FieldChoice = std::function<std::vector<std::size_t>(const std::vector<MeshField>&)>;
MeshWithFields read_vtu_fields(const std::filesystem::path& path, const FieldChoice& choice);

/// Throws InputError where a mesh has more points than its file, which tells nothing of them.
void require_own_points(const Mesh& mesh, std::size_t n_points, const std::filesystem::path& path);

}  // namespace delquad
