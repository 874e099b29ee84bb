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

/// SU2's own format, of planar meshes: a marker for each name of the boundary.
void write_su2(const std::filesystem::path& path, const Mesh& mesh) {
  if (!is_planar(mesh))
    refuse("{}: SU2 computes in planar meshes or in volumes: this is a surface in space", path.string());
  const std::vector<MeshGroup> groups = mesh_groups(mesh, {plain_label});
  const std::vector<HalfEdge> sides = sorted_half_edges(mesh);
  constexpr int kLine = 3, kTriangle = 5, kQuad = 9;
  write_text_file(path, [&](TextWriter& out) {
    out << "% quad mesh by Delquad\n";
    if (!mesh.unit.empty()) out << "% lengths in " << mesh.unit << '\n';
    for (const std::string& line : renamed_groups(groups)) out << "% " << line << '\n';
    out << "NDIME= 2\nNELEM= " << mesh.triangles.size() + mesh.quads.size() << '\n';
    int n = 0;
    const auto write = [&](int type, const auto& elements) {
      for (const auto& nodes : elements) {
        out << type;
        for (const int v : nodes) out << ' ' << v;
        out << ' ' << n++ << '\n';
      }
    };
    write(kTriangle, mesh.triangles);
    write(kQuad, mesh.quads);
    out << "NPOIN= " << mesh.points.size() << '\n';
    for (std::size_t i = 0; i < mesh.points.size(); ++i)
      out << mesh.points[i].x << ' ' << mesh.points[i].y << ' ' << i << '\n';
    // Markers are for the boundary: the solver takes no lines inside.
    std::vector<std::pair<const MeshGroup*, std::vector<int>>> markers;
    for (const MeshGroup& group : groups) {
      std::vector<int> lines;
      for (const int l : group.items)
        if (group.dim == 1 && sides_of_edge(sides, mesh.lines[l][0], mesh.lines[l][1]).size() == 1)
          lines.push_back(l);
      if (!lines.empty()) markers.emplace_back(&group, std::move(lines));
    }
    out << "NMARK= " << markers.size() << '\n';
    for (const auto& [group, lines] : markers) {
      out << "MARKER_TAG= " << group->label << "\nMARKER_ELEMS= " << lines.size() << '\n';
      for (const int l : lines) out << kLine << ' ' << mesh.lines[l][0] << ' ' << mesh.lines[l][1] << '\n';
    }
  });
}

/// In space: a marker for each name of faces on the boundary.
void write_hex_su2(const std::filesystem::path& path, const HexMesh& mesh, const HexFileOptions&) {
  std::vector<MeshGroup> groups = hex_groups(mesh, {plain_label});
  std::erase_if(groups, [](const MeshGroup& group) { return group.dim != 2; });
  const std::vector<HexSide> sides = sorted_hex_sides(mesh);
  constexpr int kQuad = 9, kHexahedron = 12;
  write_text_file(path, [&](TextWriter& out) {
    out << "% mesh of hexahedra by Delquad\n";
    if (!mesh.unit.empty()) out << "% lengths in " << mesh.unit << '\n';
    for (const std::string& line : renamed_groups(groups)) out << "% " << line << '\n';
    const auto write = [&](int type, const auto& nodes) {
      out << type;
      for (const int v : nodes) out << ' ' << v;
    };
    out << "NDIME= 3\nNELEM= " << mesh.hexahedra.size() << '\n';
    for (std::size_t h = 0; h < mesh.hexahedra.size(); ++h) {
      write(kHexahedron, mesh.hexahedra[h]);
      out << ' ' << h << '\n';
    }
    out << "NPOIN= " << mesh.points.size() << '\n';
    for (std::size_t i = 0; i < mesh.points.size(); ++i)
      out << mesh.points[i].x << ' ' << mesh.points[i].y << ' ' << mesh.points[i].z << ' ' << i << '\n';
    std::vector<std::pair<const MeshGroup*, std::vector<int>>> markers;
    for (const MeshGroup& group : groups) {
      std::vector<int> quads = group.items;
      std::erase_if(quads, [&](int q) { return sides_at_quad(mesh, sides, q).size() != 1; });
      if (!quads.empty()) markers.emplace_back(&group, std::move(quads));
    }
    out << "NMARK= " << markers.size() << '\n';
    for (const auto& [group, quads] : markers) {
      out << "MARKER_TAG= " << group->label << "\nMARKER_ELEMS= " << quads.size() << '\n';
      for (const int q : quads) {
        write(kQuad, mesh.quads[q]);
        out << '\n';
      }
    }
  });
}

}  // namespace

MeshFormat su2_format() {
  return {.extensions = {".su2"},
          .description = "SU2",
          .write = write_by<write_su2>,
          .write_hexahedra = write_hex_su2,
          .names = kBoundaryNames};
}

}  // namespace delquad
