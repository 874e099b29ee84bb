// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include "geometry/mesh/element_nodes.h"
#include "io/cell_view.h"
#include "io/mesh_formats.h"
#include "io/mesh_io.h"
#include "io/text_writer.h"

namespace delquad {

namespace {

/// A title has one line of at most 255 characters.
constexpr const char* kVtkTitle = "Quad mesh by Delquad";

/// Names have no blanks there.
std::string array_label(const std::string& name) {
  std::string label = one_line(name);
  for (char& c : label)
    if (c == ' ' || c == '"') c = '_';
  return label;
}

UniqueLabels array_labels(const std::vector<Entity>& entities) {
  std::vector<UniqueLabels::Key> keys;
  for (const Entity& entity : entities)
    for (const std::string& name : entity.names) keys.emplace_back(0, name);
  return {keys, {array_label}};
}

/// Adds field arrays of the tags that have a name.
void add_name_arrays(const char* kind, const std::vector<Entity>& entities,
                     std::vector<std::string>& arrays) {
  const UniqueLabels labels = array_labels(entities);
  for (const auto& [name, tags] : tags_of_names(entities)) {
    std::string array = fmt::format("{}_{} 1 {} int\n", kind, labels.of({0, name}), tags.size());
    for (const int tag : tags) array += std::to_string(tag) + "\n";
    arrays.push_back(std::move(array));
  }
}

/// Returns the changes of names in the file, as renamed_in_file() does.
std::vector<std::string> renamed_in_vtk(const Mesh& mesh) {
  std::vector<std::string> lines;
  for (const auto& [kind, entities] : {std::pair{"curve", &mesh.curves}, {"region", &mesh.regions}}) {
    const UniqueLabels labels = array_labels(*entities);
    for (const auto& [key, label] : labels.renamed())
      lines.push_back(fmt::format("{} \"{}\" is {}", kind, one_line(key.second), label));
  }
  return lines;
}

/// VTK's older format, as text. Cells have tags as in VTU; names are field arrays "region_NAME" of tags.
void write_vtk(const std::filesystem::path& path, const Mesh& mesh) {
  using enum CellShape;
  // VTK's cell types: straight, quadratic and biquadratic, Lagrange.
  constexpr CellCode<int> kTypes[] = {{kLine, 2, 3},  {kLine, 3, 21},    {kLine, 4, 68},
                                      {kLine, 5, 68}, {kTriangle, 3, 5}, {kQuad, 4, 9},
                                      {kQuad, 9, 28}, {kQuad, 16, 70},   {kQuad, 25, 70}};
  const std::vector<CellBlock> blocks = cell_blocks(mesh, vtk_places(mesh.order));
  write_text_file(path, [&](TextWriter& out) {
    out << "# vtk DataFile Version 3.0\n" << kVtkTitle << "\nASCII\nDATASET UNSTRUCTURED_GRID\n";
    std::vector<std::string> arrays;
    add_name_arrays("curve", mesh.curves, arrays);
    add_name_arrays("region", mesh.regions, arrays);
    if (!arrays.empty()) {
      out << "FIELD FieldData " << arrays.size() << '\n';
      for (const std::string& array : arrays) out << array;
    }
    out << "POINTS " << mesh.points.size() << " double\n";
    for (const Vec3& p : mesh.points) out << p.x << ' ' << p.y << ' ' << p.z << '\n';
    size_t n = 0, n_numbers = 0;
    for (const CellBlock& cells : blocks) n += cells.size(), n_numbers += cells.size() * (1 + cells.n_nodes);
    // This calls `write` for each cell.
    const auto each = [&](const auto& write) {
      for (const CellBlock& cells : blocks)
        for (size_t i = 0; i < cells.size(); ++i) write(cells, i), out << '\n';
    };
    out << "CELLS " << n << ' ' << n_numbers << '\n';
    each([&](const CellBlock& cells, size_t i) {
      out << cells.n_nodes;
      for (const int v : cells.nodes(i)) out << ' ' << v;
    });
    out << "CELL_TYPES " << n << '\n';
    each([&](const CellBlock& cells, size_t) { out << code_of(cells, kTypes); });
    out << "CELL_DATA " << n << '\n';
    for (const int dim : {1, 2}) {
      out << "SCALARS " << (dim == 1 ? "curve" : "region") << " int 1\nLOOKUP_TABLE default\n";
      each([&](const CellBlock& cells, size_t i) { out << (cells.dim == dim ? cells.entity(i).tag : 0); });
    }
  });
}

}  // namespace

MeshFormat vtk_format() {
  return {.extensions = {".vtk"},
          .description = "VTK legacy, text",
          .write = write_by<write_vtk>,
          .most_order = kMostOrder,
          .renamed = renamed_in_vtk,
          .names = (kAllNames & ~kPointNames) | kFurtherNames};
}

}  // namespace delquad
