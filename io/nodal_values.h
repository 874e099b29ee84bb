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

/// The index of the field `name`, the last one of several; of the only name that there is where `name` is
/// empty. Throws InputError where there is none, or where it has other than `n_components`.
std::size_t choose_field(const std::vector<FieldInFile>& fields, const std::string& name,
                         const std::string& file, int n_components = 1);

/// Means, by area, of the values of the elements at each point; NaN where there is no element.
std::vector<double> means_at_points(const Mesh& mesh, const std::vector<double>& of_triangles,
                                    const std::vector<double>& of_quads);

/// read_values() of a VTU file.
NodalValues read_vtu_field(const std::filesystem::path& path, const std::string& name);

}  // namespace delquad
