#include "io/formats/vtu.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <limits>
#include <stdexcept>
#include <string_view>

#include "delquad/hexahedra.h"
#include "geometry/mesh/element_nodes.h"
#include "io/entity_names.h"
#include "io/mesh_formats.h"
#include "io/text_writer.h"
#include "io/xml.h"
#include "metrics/metrics.h"

namespace delquad {
namespace {

using NumbersOfNames = std::map<std::string, std::vector<std::int32_t>>;

/// What a file says, whatever cells it holds.
struct VtuContent {
  const std::vector<Vec3>& points;
  const std::string& unit;  ///< empty: not known
  /// Kind of entity -> numbers of each name, which become arrays "KIND NAME".
  std::vector<std::pair<std::string, NumbersOfNames>> names;
  std::vector<std::pair<std::string, std::vector<std::int32_t>>> tags;  ///< of cells; 0: none
  std::vector<MeshField> fields = {};                                   ///< of points, and of all cells
  std::vector<std::int64_t> connectivity = {}, offsets = {};
  std::vector<std::uint8_t> types = {};

  /// `numbers`: one of each of `tags`.
  template <class Nodes>
  void add(const Nodes& nodes, std::uint8_t type, std::initializer_list<int> numbers) {
    connectivity.insert(connectivity.end(), nodes.begin(), nodes.end());
    offsets.push_back(static_cast<std::int64_t>(connectivity.size()));
    types.push_back(type);
    for (std::size_t k = 0; k < tags.size(); ++k) tags[k].second.push_back(numbers.begin()[k]);
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

/// Hexahedra first, then quads and lines, with the numbers of their volumes, faces and curves (arrays
/// `volume`, `face`, `curve`; 0: none) and of hexahedra the least scaled Jacobian.
void write_hex_vtu(const std::filesystem::path& path, const Mesh& mesh) {
  constexpr std::uint8_t kLine = 3, kQuad = 9, kHexahedron = 12;  // VTK's cell types
  VtuContent content{mesh.points,
                     mesh.unit,
                     {{"volume", tags_of_names(mesh.volumes)},
                      {"face", tags_of_names(mesh.regions)},
                      {"curve", tags_of_names(mesh.curves)}},
                     {{"volume", {}}, {"face", {}}, {"curve", {}}}};
  for (std::size_t i = 0; i < mesh.hexahedra.size(); ++i)
    content.add(mesh.hexahedra[i], kHexahedron, {mesh.volumes[mesh.hex_volume[i]].tag, 0, 0});
  for (std::size_t i = 0; i < mesh.quads.size(); ++i)
    content.add(mesh.quads[i], kQuad, {0, mesh.regions[mesh.quad_region[i]].tag, 0});
  for (std::size_t i = 0; i < mesh.lines.size(); ++i)
    content.add(mesh.lines[i], kLine, {0, 0, mesh.curves[mesh.line_curve[i]].tag});
  std::vector<double> jacobian = measure(mesh).jacobian;
  jacobian.resize(content.types.size(), std::numeric_limits<double>::quiet_NaN());
  content.fields.push_back({"scaled Jacobian", false, 1, std::move(jacobian)});
  write_text_file(path, [&](TextWriter& out) { write_content(out, content); });
}

void write_with_eta(const std::filesystem::path& path, const Mesh& mesh, const MshOptions&, QuadNodes nodes) {
  if (!mesh.hexahedra.empty()) return write_hex_vtu(path, mesh);
  std::vector<double> eta(mesh.lines.size() + mesh.triangles.size(),
                          std::numeric_limits<double>::quiet_NaN());
  const std::vector<double> of_quads = quad_etas(mesh);
  eta.insert(eta.end(), of_quads.begin(), of_quads.end());
  write_vtu(path, mesh, {{"eta", eta}}, nodes);
}

}  // namespace

void write_vtu(const std::filesystem::path& path, const Mesh& mesh,
               const std::map<std::string, std::vector<double>>& cell_data, QuadNodes nodes,
               const std::vector<MeshField>& fields) {
  // VTK's cell types: straight, quadratic and biquadratic, Lagrange.
  constexpr std::array<std::uint8_t, 4> kLines = {3, 21, 68, 68}, kQuads = {9, 28, 70, 70};
  constexpr std::uint8_t kTriangle = 5, kEightNodes = 23;
  const size_t order = static_cast<size_t>(mesh.order) - 1;
  VtuContent content{mesh.points,
                     mesh.unit,
                     {{"curve", tags_of_names(mesh.curves)},
                      {"region", tags_of_names(mesh.regions)},
                      {"point", points_of_names(mesh)}},
                     {{"curve", {}}, {"region", {}}}};
  for (size_t i = 0; i < mesh.lines.size(); ++i)
    content.add(nodes_ends_first(mesh, i), kLines[order], {mesh.curves[mesh.line_curve[i]].tag, 0});
  for (size_t i = 0; i < mesh.triangles.size(); ++i)
    content.add(mesh.triangles[i], kTriangle, {0, mesh.regions[mesh.triangle_region[i]].tag});
  std::vector<int> places = vtk_places(mesh.order);
  if (nodes == QuadNodes::kNoMiddle) places.pop_back();
  const std::uint8_t of_quads = nodes == QuadNodes::kNoMiddle ? kEightNodes : kQuads[order];
  for (size_t i = 0; i < mesh.quads.size(); ++i)
    content.add(nodes_of_quad(mesh, i, places), of_quads, {0, mesh.regions[mesh.quad_region[i]].tag});
  for (const auto& [name, values] : cell_data) {
    if (values.size() != content.types.size()) {
      throw std::invalid_argument("cell data '" + name + "': " + std::to_string(values.size()) +
                                  " values for " + std::to_string(content.types.size()) + " cells");
    }
    content.fields.push_back({name, false, 1, values});
  }
  for (MeshField field : fields) {
    if (!field.is_of_points)
      field.values.insert(field.values.begin(), field.n_components * mesh.lines.size(),
                          std::numeric_limits<double>::quiet_NaN());
    content.fields.push_back(std::move(field));
  }
  write_text_file(path, [&](TextWriter& out) { write_content(out, content); });
}

MeshFormat vtu_format() {
  return {.extensions = {".vtu"},
          .description = "VTK XML, ParaView",
          .read = read_by<read_vtu>,
          .write = write_with_eta,
          .most_order = kMostOrder,
          .has_hexahedra = true,
          .eight_nodes = EightNodes::kWhenAsked,
          .names = kAllNames | kFurtherNames};
}

}  // namespace delquad
