#include <fmt/format.h>

#include <array>

#include "geometry/mesh/element_nodes.h"
#include "io/entity_names.h"
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

/// What becomes of names there, as renamed_in_file() tells it.
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
  // VTK's cell types: straight, quadratic and biquadratic, Lagrange.
  constexpr std::array kLines = {3, 21, 68, 68}, kQuads = {9, 28, 70, 70};
  constexpr int kTriangle = 5;
  const std::vector<int> places = mesh.order == 2 ? gmsh_places(2) : vtk_places(mesh.order);
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
    const size_t n = mesh.lines.size() + mesh.triangles.size() + mesh.quads.size();
    const size_t row = static_cast<size_t>(mesh.order) + 1;
    out << "CELLS " << n << ' '
        << n + row * mesh.lines.size() + 3 * mesh.triangles.size() + row * row * mesh.quads.size() << '\n';
    const auto write = [&](const auto& nodes) {
      out << nodes.size();
      for (const int v : nodes) out << ' ' << v;
      out << '\n';
    };
    for (size_t i = 0; i < mesh.lines.size(); ++i) write(nodes_ends_first(mesh, i));
    for (const auto& v : mesh.triangles) write(v);
    for (size_t i = 0; i < mesh.quads.size(); ++i) write(nodes_of_quad(mesh, i, places));
    out << "CELL_TYPES " << n << '\n';
    const size_t order = static_cast<size_t>(mesh.order) - 1;
    for (size_t i = 0; i < mesh.lines.size(); ++i) out << kLines[order] << '\n';
    for (size_t i = 0; i < mesh.triangles.size(); ++i) out << kTriangle << '\n';
    for (size_t i = 0; i < mesh.quads.size(); ++i) out << kQuads[order] << '\n';
    out << "CELL_DATA " << n << "\nSCALARS curve int 1\nLOOKUP_TABLE default\n";
    for (const int c : mesh.line_curve) out << mesh.curves[c].tag << '\n';
    for (size_t i = mesh.lines.size(); i < n; ++i) out << "0\n";
    out << "SCALARS region int 1\nLOOKUP_TABLE default\n";
    for (size_t i = 0; i < mesh.lines.size(); ++i) out << "0\n";
    for (const auto* regions : {&mesh.triangle_region, &mesh.quad_region})
      for (const int r : *regions) out << mesh.regions[r].tag << '\n';
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
