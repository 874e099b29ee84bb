#include "io/formats/readers.h"
#include "io/mesh_formats.h"
#include "io/mesh_groups.h"
#include "io/mesh_io.h"
#include "io/text_writer.h"

namespace delquad {
namespace {

/// Unstructured cell data of AVS, as deal.II reads it, too: the material of a cell is the number of its name,
/// which comments tell.
void write_ucd(const std::filesystem::path& path, const Mesh& mesh) {
  const std::vector<MeshGroup> groups = mesh_groups(mesh, {one_line_label});
  const std::size_t n_elements = mesh.triangles.size() + mesh.quads.size();
  const std::vector<int> of_lines = group_numbers(groups, 1, mesh.lines.size());
  const std::vector<int> of_elements = group_numbers(groups, 2, n_elements);
  std::size_t n_lines = 0;
  for (const int g : of_lines) n_lines += g > 0;
  write_file_atomically(path, [&](std::ostream& stream) {
    TextWriter out(stream);
    out << "# quad mesh by Delquad\n";
    if (!mesh.unit.empty()) out << "# lengths in " << mesh.unit << '\n';
    for (const MeshGroup& group : groups)
      if (group.dim > 0)
        out << "# material " << group.number << (group.dim == 1 ? " of lines: " : ": ")
            << one_line(group.name) << '\n';
    out << mesh.points.size() << ' ' << n_lines + n_elements << " 0 0 0\n";
    for (std::size_t i = 0; i < mesh.points.size(); ++i) {
      const Vec3& p = mesh.points[i];
      out << i + 1 << ' ' << p.x << ' ' << p.y << ' ' << p.z << '\n';
    }
    int n = 0;
    const auto write = [&](int material, const char* type, const auto& nodes) {
      out << ++n << ' ' << material << ' ' << type;
      for (const int v : nodes) out << ' ' << v + 1;
      out << '\n';
    };
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) write(of_elements[t], "tri", mesh.triangles[t]);
    for (std::size_t q = 0; q < mesh.quads.size(); ++q)
      write(of_elements[mesh.triangles.size() + q], "quad", mesh.quads[q]);
    for (std::size_t l = 0; l < mesh.lines.size(); ++l)
      if (of_lines[l] > 0) write(of_lines[l], "line", mesh.lines[l]);
    out.flush();
  });
}

}  // namespace

MeshFormat ucd_format() {
  return {{".ucd", ".avs"}, "AVS unstructured cell data: deal.II", read_by<read_ucd>, write_by<write_ucd>};
}

}  // namespace delquad
