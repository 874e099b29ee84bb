#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
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
/// empty. Throws InputError where there is none, or where it has other than one of `n_components`.
std::size_t choose_field(const std::vector<FieldInFile>& fields, const std::string& name,
                         const std::string& file, std::span<const int> n_components);

/// Means, by area, of the values of the elements at each point, `width` side by side; NaN where there is no
/// element.
std::vector<double> means_at_points(const Mesh& mesh, const std::vector<double>& of_triangles,
                                    const std::vector<double>& of_quads, std::size_t width = 1);

/// read_values() of a VTU file, or, with a width of 6, read_tensors().
NodalValues read_vtu_field(const std::filesystem::path& path, const std::string& name, std::size_t width);

}  // namespace delquad
