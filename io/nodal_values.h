#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "io/mesh_io.h"

namespace delquad {

/// What a file says of a field before its values.
struct FieldInFile {
  std::string name;
  bool is_of_points;  ///< or else of elements
  int n_components;
};

/// What is asked of a field.
struct FieldForm {
  std::vector<int> n_components = {1};  ///< one of these
  bool of_points = false;               ///< not of elements
  bool are_tensors = false;             ///< of m11, m12, m13, m22, m23 and m33, once they are read
};

/// The index of the field `name`, the last one of several; of the only name that there is where `name` is
/// empty. Throws InputError where there is none, or where it has another form.
std::size_t choose_field(const std::vector<FieldInFile>& fields, const std::string& name,
                         const std::string& file, const FieldForm& form);

/// Means, by area, of the values of the elements at each point, `width` side by side; NaN where there is no
/// element.
std::vector<double> means_at_points(const Mesh& mesh, const std::vector<double>& of_triangles,
                                    const std::vector<double>& of_quads, std::size_t width = 1);

/// A field of a VTU file, whose name `name` becomes.
NodalValues read_vtu_field(const std::filesystem::path& path, std::string& name, const FieldForm& form);

}  // namespace delquad
