// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "geometry/mesh/cell_shapes.h"
#include "io/mesh_io.h"

// This header chooses fields of files. Readers of fields and the program use it.

namespace delquad {

/// The form of a field that a caller expects.
struct FieldForm {
  std::vector<int> n_components = {1};  ///< one of these
  bool of_points = false;               ///< not of elements
};

/// Returns the index of the field `name`, or of the only field if `name` is empty; the last of several
/// counts. Throws InputError, beginning with `file`, for a missing field or another form.
std::size_t choose_field(const std::vector<MeshField>& fields, const std::string& name,
                         const std::string& file, const FieldForm& form);

/// Selects the fields to read, by their headers in the file.
using FieldChoice = std::function<std::vector<std::size_t>(const std::vector<MeshField>&)>;
/// Reads the selected fields of a VTU file. Throws InputError with the file.
MeshWithFields read_vtu_fields(const std::filesystem::path& path, const FieldChoice& choice);

/// Returns whether a field is Mesh::thickness, by its name and form.
inline bool is_thickness(const MeshField& field) {
  return field.name == "thickness" && !field.is_of_points && field.n_components == 1;
}
/// Sets the thickness of a mesh, unless an element has none.
inline void set_thickness(std::vector<double> values, Mesh& mesh) {
  if (!is_solid(mesh) && std::ranges::all_of(values, [](double t) { return t > 0; }))
    mesh.thickness = std::move(values);
}

/// Throws InputError if a mesh has more points than its file.
void require_own_points(const Mesh& mesh, std::size_t n_points, const std::filesystem::path& path);

}  // namespace delquad
