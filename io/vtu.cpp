#include <array>
#include <bit>
#include <cstdint>
#include <stdexcept>

#include "io/mesh_io.h"
#include "io/text_writer.h"
#include "io/xml.h"
#include "mesh/element_nodes.h"

namespace delquad {

namespace {

/// Base64 of a block of bytes after its length, as VTK wants it inline (header_type UInt64).
class Base64Array {
 public:
  explicit Base64Array(TextWriter& out) : out_(out) {}

  template <class T>
  void write(const std::vector<T>& values) {
    const std::uint64_t n_bytes = values.size() * sizeof(T);
    put(&n_bytes, sizeof n_bytes);
    put(values.data(), n_bytes);
    if (n_held_ > 0) {
      const int padding = 3 - n_held_;
      held_ <<= 8 * padding;
      emit(4 - padding);
      out_ << (padding == 1 ? "=" : "==");
    }
  }

 private:
  void put(const void* data, size_t n_bytes) {
    const auto* bytes = static_cast<const unsigned char*>(data);
    for (size_t i = 0; i < n_bytes; ++i) {
      held_ = held_ << 8 | bytes[i];
      if (++n_held_ == 3) emit(4);
    }
  }
  void emit(int n_digits) {
    static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    char text[4];
    for (int k = 0; k < n_digits; ++k) text[k] = kDigits[held_ >> (18 - 6 * k) & 63];
    out_ << std::string_view(text, static_cast<size_t>(n_digits));
    held_ = 0;
    n_held_ = 0;
  }

  TextWriter& out_;
  std::uint32_t held_ = 0;
  int n_held_ = 0;
};

template <class T>
void write_array(TextWriter& out, std::string_view attributes, const std::vector<T>& values) {
  out << "        <DataArray " << attributes << " format=\"binary\">";
  Base64Array(out).write(values);
  out << "</DataArray>\n";
}

struct Cells {
  std::vector<std::int64_t> connectivity, offsets;
  std::vector<std::uint8_t> types;
  std::vector<std::int32_t> curves, regions;  ///< tags; 0: none

  /// `nodes_of`: of an element by its index.
  template <class NodesOf>
  void add(const std::vector<int>& entity_of, const std::vector<Entity>& all, bool are_lines,
           std::uint8_t type, const NodesOf& nodes_of) {
    for (size_t i = 0; i < entity_of.size(); ++i) {
      const auto& nodes = nodes_of(i);
      connectivity.insert(connectivity.end(), nodes.begin(), nodes.end());
      offsets.push_back(static_cast<std::int64_t>(connectivity.size()));
      types.push_back(type);
      const int tag = all[entity_of[i]].tag;
      curves.push_back(are_lines ? tag : 0);
      regions.push_back(are_lines ? 0 : tag);
    }
  }
};

using NumbersOfNames = std::map<std::string, std::vector<std::int32_t>>;

NumbersOfNames tags_of_names(const std::vector<Entity>& entities) {
  NumbersOfNames tags;
  for (const Entity& entity : entities)
    for (const std::string& name : entity.names) tags[name].push_back(entity.tag);
  return tags;
}

NumbersOfNames points_of_names(const Mesh& mesh) {
  NumbersOfNames points;
  for (const NamedPoint& named : mesh.named_points)
    for (const std::string& name : named.entity.names) points[name].push_back(named.point);
  return points;
}

/// Arrays of numbers, which every reader takes: meshio refuses arrays of strings.
void write_name_arrays(TextWriter& out, const char* kind, const NumbersOfNames& numbers) {
  for (const auto& [name, all] : numbers)
    write_array(out,
                "type=\"Int32\" Name=\"" + std::string(kind) + ' ' + xml_escaped(name) +
                    "\" NumberOfTuples=\"" + std::to_string(all.size()) + '"',
                all);
}

void write_file(TextWriter& out, const Mesh& mesh, const Cells& cells,
                const std::map<std::string, std::vector<double>>& cell_data) {
  constexpr bool kLittle = std::endian::native == std::endian::little;
  out << "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\""
      << (kLittle ? "LittleEndian" : "BigEndian") << "\" header_type=\"UInt64\">\n  <UnstructuredGrid>\n";
  if (!mesh.unit.empty()) out << "    <!-- lengths in " << mesh.unit << " -->\n";
  out << "      <FieldData>\n";
  write_name_arrays(out, "curve", tags_of_names(mesh.curves));
  write_name_arrays(out, "region", tags_of_names(mesh.regions));
  write_name_arrays(out, "point", points_of_names(mesh));
  out << "      </FieldData>\n";
  out << "    <Piece NumberOfPoints=\"" << mesh.points.size() << "\" NumberOfCells=\"" << cells.types.size()
      << "\">\n";
  std::vector<double> coordinates;
  coordinates.reserve(3 * mesh.points.size());
  for (const Vec3& p : mesh.points) coordinates.insert(coordinates.end(), {p.x, p.y, p.z});
  out << "      <Points>\n";
  write_array(out, "type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\"", coordinates);
  out << "      </Points>\n      <Cells>\n";
  write_array(out, "type=\"Int64\" Name=\"connectivity\"", cells.connectivity);
  write_array(out, "type=\"Int64\" Name=\"offsets\"", cells.offsets);
  write_array(out, "type=\"UInt8\" Name=\"types\"", cells.types);
  out << "      </Cells>\n      <CellData>\n";
  write_array(out, "type=\"Int32\" Name=\"curve\"", cells.curves);
  write_array(out, "type=\"Int32\" Name=\"region\"", cells.regions);
  for (const auto& [name, values] : cell_data) {
    write_array(out, "type=\"Float64\" Name=\"" + xml_escaped(name) + "\"", values);
  }
  out << "      </CellData>\n    </Piece>\n  </UnstructuredGrid>\n</VTKFile>\n";
}

}  // namespace

void write_vtu(const std::filesystem::path& path, const Mesh& mesh,
               const std::map<std::string, std::vector<double>>& cell_data) {
  // VTK's cell types: straight, quadratic and biquadratic, Lagrange.
  constexpr std::array<std::uint8_t, 4> kLines = {3, 21, 68, 68}, kQuads = {9, 28, 70, 70};
  constexpr std::uint8_t kTriangle = 5;
  const size_t order = static_cast<size_t>(mesh.order) - 1;
  Cells cells;
  cells.add(mesh.line_curve, mesh.curves, true, kLines[order],
            [&](size_t i) { return nodes_ends_first(mesh, i); });
  cells.add(
      mesh.triangle_region, mesh.regions, false,
      kTriangle, [&](size_t i) -> const auto& { return mesh.triangles[i]; });
  const std::vector<int> places = mesh.order == 2 ? gmsh_places(2) : vtk_places(mesh.order);
  cells.add(mesh.quad_region, mesh.regions, false, kQuads[order],
            [&](size_t i) { return nodes_of_quad(mesh, i, places); });
  for (const auto& [name, values] : cell_data) {
    if (values.size() != cells.types.size()) {
      throw std::invalid_argument("cell data '" + name + "': " + std::to_string(values.size()) +
                                  " values for " + std::to_string(cells.types.size()) + " cells");
    }
  }
  write_file_atomically(path, [&](std::ostream& stream) {
    TextWriter out(stream);
    write_file(out, mesh, cells, cell_data);
    out.flush();
  });
}

}  // namespace delquad
