#include "base/located.h"
#include "io/entity_names.h"
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

}  // namespace

MeshFormat su2_format() {
  return {
      .extensions = {".su2"}, .description = "SU2", .write = write_by<write_su2>, .names = kBoundaryNames};
}

}  // namespace delquad
