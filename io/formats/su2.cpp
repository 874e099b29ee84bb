#include <fmt/format.h>

#include <map>
#include <numbers>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "base/located.h"
#include "io/entity_names.h"
#include "io/hex_sides.h"
#include "io/mesh_formats.h"
#include "io/mesh_io.h"
#include "io/text_writer.h"

namespace delquad {
namespace {

/// Writes elements of the dimension by `each_element`, and a marker for each group of sides, of type
/// `side_type`. The solver takes no sides inside: `is_outside` says which are around the mesh.
template <class EachElement, class Sides, class IsOutside, class WriteComments>
void write_elements(const std::filesystem::path& path, const Mesh& mesh, int dim, const char* title,
                    std::size_t n_elements, const EachElement& each_element, int side_type,
                    const Sides& sides, const IsOutside& is_outside, const WriteComments& write_comments) {
  std::vector<MeshGroup> groups = mesh_groups(mesh, {plain_label});
  write_text_file(path, [&](TextWriter& out) {
    out << "% " << title << " by Delquad\n";
    if (!mesh.unit.empty()) out << "% lengths in " << mesh.unit << '\n';
    std::erase_if(groups, [&](const MeshGroup& group) { return group.dim != dim - 1; });
    for (MeshGroup& group : groups) std::erase_if(group.items, [&](int side) { return !is_outside(side); });
    std::erase_if(groups, [](const MeshGroup& group) { return group.items.empty(); });
    for (const std::string& line : renamed_groups(groups)) out << "% " << line << '\n';
    write_comments(out, groups);
    const auto write = [&](int type, const auto& nodes) {
      out << type;
      for (const int v : nodes) out << ' ' << v;
    };
    out << "NDIME= " << dim << "\nNELEM= " << n_elements << '\n';
    int n = 0;
    each_element([&](int type, const auto& nodes) {
      write(type, nodes);
      out << ' ' << n++ << '\n';
    });
    out << "NPOIN= " << mesh.points.size() << '\n';
    for (std::size_t i = 0; i < mesh.points.size(); ++i) {
      out << mesh.points[i].x << ' ' << mesh.points[i].y << ' ';
      if (dim == 3) out << mesh.points[i].z << ' ';
      out << i << '\n';
    }
    out << "NMARK= " << groups.size() << '\n';
    for (const MeshGroup& group : groups) {
      out << "MARKER_TAG= " << group.label << "\nMARKER_ELEMS= " << group.items.size() << '\n';
      for (const int side : group.items) {
        write(side_type, sides[side]);
        out << '\n';
      }
    }
  });
}

/// Tells the settings that SU2 has for periodic markers: center, angles in degrees, shift.
void write_periodic(TextWriter& out, const Mesh& mesh, const std::vector<MeshGroup>& groups) {
  std::map<int, std::string> label_of;  // by curve
  for (const MeshGroup& group : groups)
    for (const int l : group.items) label_of[mesh.line_curve[l]] = group.label;
  std::set<std::string> written;
  for (const PeriodicNodes& pair : mesh.periodic) {
    const auto from = label_of.find(pair.master), to = label_of.find(pair.curve);
    if (from == label_of.end() || to == label_of.end()) continue;
    const auto& [shift, angle, centre, axis] = pair.motion;
    const double turn = angle * 180 / std::numbers::pi * (axis.z < 0 ? -1 : 1);
    const std::string line = fmt::format("{}, {}, {}, {}, 0, 0, 0, {}, {}, {}, 0", from->second, to->second,
                                         centre.x, centre.y, turn, shift.x, shift.y);
    if (written.insert(line).second) out << "% MARKER_PERIODIC= ( " << line << " )\n";
  }
}

constexpr int kVtkLine = 3, kVtkTriangle = 5, kVtkQuad = 9, kVtkHexahedron = 12;

void write_hex_su2(const std::filesystem::path& path, const Mesh& mesh) {
  const std::vector<HexSide> sides = sorted_hex_sides(mesh);
  const auto each = [&](const auto& write) {
    for (const auto& v : mesh.hexahedra) write(kVtkHexahedron, v);
  };
  write_elements(
      path, mesh, 3, "mesh of hexahedra", mesh.hexahedra.size(), each, kVtkQuad, mesh.quads,
      [&](int q) { return sides_at_quad(mesh, sides, q).size() == 1; },
      [](TextWriter&, const std::vector<MeshGroup>&) {});
}

void write_su2(const std::filesystem::path& path, const Mesh& mesh) {
  if (!mesh.hexahedra.empty()) return write_hex_su2(path, mesh);
  if (!is_planar(mesh))
    refuse("{}: SU2 computes in planar meshes or in volumes: this is a surface in space", path.string());
  const std::vector<HalfEdge> sides = sorted_half_edges(mesh);
  const auto each = [&](const auto& write) {
    for (const auto& v : mesh.triangles) write(kVtkTriangle, v);
    for (const auto& v : mesh.quads) write(kVtkQuad, v);
  };
  write_elements(
      path, mesh, 2, "quad mesh", mesh.triangles.size() + mesh.quads.size(), each, kVtkLine, mesh.lines,
      [&](int l) { return sides_of_edge(sides, mesh.lines[l][0], mesh.lines[l][1]).size() == 1; },
      [&](TextWriter& out, const std::vector<MeshGroup>& groups) { write_periodic(out, mesh, groups); });
}

}  // namespace

MeshFormat su2_format() {
  return {.extensions = {".su2"},
          .description = "SU2",
          .write = write_by<write_su2>,
          .has_hexahedra = true,
          .names = kBoundaryNames | kPeriodicPairs};
}

}  // namespace delquad
