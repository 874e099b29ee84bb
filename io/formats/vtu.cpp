// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/formats/vtu.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string_view>

#include "delquad/hexahedra.h"
#include "geometry/mesh/element_nodes.h"
#include "io/cell_view.h"
#include "io/mesh_formats.h"
#include "io/text_writer.h"
#include "io/xml.h"
#include "metrics/metrics.h"

namespace delquad {
namespace {

using NumbersOfNames = std::map<std::string, std::vector<std::int32_t>>;

/// The contents of a file, whatever cells it has.
struct VtuContent {
  const std::vector<Vec3>& points;
  const std::string& unit;  ///< empty: not known
  /// Kind of entity -> numbers of each name, which become arrays "KIND NAME".
  std::vector<std::pair<std::string, NumbersOfNames>> names = {};
  std::vector<std::pair<std::string, std::vector<std::int32_t>>> tags = {};  ///< of cells; 0: none
  std::vector<MeshField> fields = {};                                        ///< of points, and of all cells
  std::vector<std::int64_t> connectivity = {}, offsets = {};
  std::vector<std::uint8_t> types = {};

  void add(const std::vector<int>& nodes, std::uint8_t type) {
    connectivity.insert(connectivity.end(), nodes.begin(), nodes.end());
    offsets.push_back(static_cast<std::int64_t>(connectivity.size()));
    types.push_back(type);
  }
};

/// In base64 after its length in bytes, as VTK wants it inline (header_type UInt64).
template <class T>
void write_array(TextWriter& out, std::string_view attributes, const std::vector<T>& values) {
  const std::uint64_t n_bytes = values.size() * sizeof(T);
  std::string bytes(sizeof n_bytes + n_bytes, '\0');
  std::memcpy(bytes.data(), &n_bytes, sizeof n_bytes);
  if (n_bytes > 0) std::memcpy(bytes.data() + sizeof n_bytes, values.data(), n_bytes);
  out << "        <DataArray " << attributes << " format=\"binary\">" << base64(bytes) << "</DataArray>\n";
}

/// Arrays of numbers, which every reader takes: meshio refuses arrays of strings.
void write_name_arrays(TextWriter& out, const std::string& kind, const NumbersOfNames& numbers) {
  for (const auto& [name, all] : numbers)
    write_array(out,
                "type=\"Int32\" Name=\"" + kind + ' ' + xml_escaped(name) + "\" NumberOfTuples=\"" +
                    std::to_string(all.size()) + '"',
                all);
}

void write_content(TextWriter& out, const VtuContent& content) {
  constexpr bool kLittle = std::endian::native == std::endian::little;
  out << "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\""
      << (kLittle ? "LittleEndian" : "BigEndian") << "\" header_type=\"UInt64\">\n  <UnstructuredGrid>\n";
  if (!content.unit.empty()) out << "    <!-- lengths in " << content.unit << " -->\n";
  out << "      <FieldData>\n";
  for (const auto& [kind, numbers] : content.names) write_name_arrays(out, kind, numbers);
  out << "      </FieldData>\n";
  out << "    <Piece NumberOfPoints=\"" << content.points.size() << "\" NumberOfCells=\""
      << content.types.size() << "\">\n";
  std::vector<double> coordinates;
  coordinates.reserve(3 * content.points.size());
  for (const Vec3& p : content.points) coordinates.insert(coordinates.end(), {p.x, p.y, p.z});
  out << "      <Points>\n";
  write_array(out, "type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\"", coordinates);
  out << "      </Points>\n      <Cells>\n";
  write_array(out, "type=\"Int64\" Name=\"connectivity\"", content.connectivity);
  write_array(out, "type=\"Int64\" Name=\"offsets\"", content.offsets);
  write_array(out, "type=\"UInt8\" Name=\"types\"", content.types);
  out << "      </Cells>\n";
  const auto write_fields = [&](bool of_points) {
    for (const auto& [name, is_of_points, n_components, values] : content.fields)
      if (is_of_points == of_points)
        write_array(
            out,
            "type=\"Float64\" Name=\"" + xml_escaped(name) + '"' +
                (n_components == 1 ? "" : " NumberOfComponents=\"" + std::to_string(n_components) + '"'),
            values);
  };
  const bool has_of_points = std::ranges::any_of(content.fields, &MeshField::is_of_points);
  if (has_of_points) out << "      <PointData>\n";
  write_fields(true);
  if (has_of_points) out << "      </PointData>\n";
  out << "      <CellData>\n";
  for (const auto& [name, tags] : content.tags) write_array(out, "type=\"Int32\" Name=\"" + name + '"', tags);
  write_fields(false);
  out << "      </CellData>\n    </Piece>\n  </UnstructuredGrid>\n</VTKFile>\n";
}

NumbersOfNames points_of_names(const Mesh& mesh) {
  NumbersOfNames points;
  for (const NamedPoint& named : mesh.named_points)
    for (const std::string& name : named.entity.names) points[name].push_back(named.point);
  return points;
}

void write_with_quality(const std::filesystem::path& path, const Mesh& mesh, const MshOptions&) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  if (is_solid(mesh)) {
    std::vector<double> jacobian = measure(mesh).jacobian;
    jacobian.resize(jacobian.size() + n_cells(mesh, 2) + n_cells(mesh, 1), kNone);
    return write_vtu(path, mesh, {{"scaled Jacobian", jacobian}});
  }
  std::vector<double> eta(mesh.lines.size() + mesh.triangles.size(), kNone);
  const std::vector<double> of_quads = quad_etas(mesh);
  eta.insert(eta.end(), of_quads.begin(), of_quads.end());
  std::map<std::string, std::vector<double>> data = {{"eta", std::move(eta)}};
  if (!mesh.thickness.empty()) {
    std::vector<double>& thickness = data["thickness"] = mesh.thickness;
    thickness.insert(thickness.begin(), mesh.lines.size(), kNone);
  }
  write_vtu(path, mesh, data);
}

}  // namespace

void write_vtu(const std::filesystem::path& path, const Mesh& mesh,
               const std::map<std::string, std::vector<double>>& cell_data,
               const std::vector<MeshField>& fields) {
  using enum CellShape;
  // VTK's cell types: straight, quadratic and biquadratic, Lagrange. The first triangle of a wedge looks
  // outwards.
  constexpr CellCode<std::uint8_t> kTypes[] = {
      {kLine, 2, 3},     {kLine, 3, 21},       {kLine, 4, 68},       {kLine, 5, 68},
      {kTriangle, 3, 5}, {kQuad, 4, 9},        {kQuad, 8, 23},       {kQuad, 9, 28},
      {kQuad, 16, 70},   {kQuad, 25, 70},      {kHexahedron, 8, 12}, {kPrism, 6, 13, "021354"},
      {kPyramid, 5, 14}, {kTetrahedron, 4, 10}};
  const bool is_volume = is_solid(mesh);
  const std::array<const std::vector<Entity>*, 4> entities = {nullptr, &mesh.curves, &mesh.regions,
                                                              &mesh.volumes};
  VtuContent content{mesh.points, mesh.unit};
  const std::vector<int> dims = is_volume ? std::vector{3, 2, 1} : std::vector{1, 2};
  for (const int dim : dims) {
    const char* const kind = dim == 1 ? "curve" : dim == 3 ? "volume" : is_volume ? "face" : "region";
    content.names.emplace_back(kind, tags_of_names(*entities[dim]));
    content.tags.push_back({kind, {}});
  }
  content.names.emplace_back("point", points_of_names(mesh));
  const std::vector<CellBlock> blocks = cell_blocks(mesh, vtk_places(mesh.order));
  for (const int dim : dims)
    for (const CellBlock& cells : blocks)
      for (size_t i = 0; i < cells.size() && cells.dim == dim; ++i) {
        content.add(nodes_of(cells, i, kTypes), code_of(cells, kTypes));
        for (size_t k = 0; k < dims.size(); ++k)
          content.tags[k].second.push_back(dims[k] == dim ? cells.entity(i).tag : 0);
      }
  for (const auto& [name, values] : cell_data) {
    if (values.size() != content.types.size()) {
      throw std::invalid_argument("cell data '" + name + "': " + std::to_string(values.size()) +
                                  " values for " + std::to_string(content.types.size()) + " cells");
    }
    content.fields.push_back({name, false, 1, values});
  }
  for (MeshField field : fields) {
    if (!field.is_of_points)  // cells of lower dimension have no values
      field.values.insert(is_volume ? field.values.end() : field.values.begin(),
                          field.n_components * (content.types.size() - n_cells(mesh, dimension_of(mesh))),
                          std::numeric_limits<double>::quiet_NaN());
    content.fields.push_back(std::move(field));
  }
  write_text_file(path, [&](TextWriter& out) { write_content(out, content); });
}

MeshFormat vtu_format() {
  return {.extensions = {".vtu"},
          .description = "VTK XML, ParaView",
          .read = [](const std::filesystem::path& path, ReadNotes* notes,
                     Strays) { return read_vtu(path, notes); },
          .write = write_with_quality,
          .most_order = kMostOrder,
          .has_cells = true,
          .eight_nodes = EightNodes::kOnRequest,
          .names = kAllNames | kFurtherNames};
}

}  // namespace delquad
