#include "io/entity_names.h"
#include "io/formats/readers.h"
#include "io/mesh_formats.h"
#include "io/mesh_io.h"
#include "io/text_writer.h"

namespace delquad {

namespace {

void write_names(TextWriter& out, const char* kind, const std::vector<Entity>& entities) {
  for (const Entity& entity : entities)
    for (const std::string& name : entity.names)
      out << "# " << kind << ' ' << entity.tag << ": " << one_line(name) << '\n';
}

template <size_t N>
void write_elements(TextWriter& out, const char* keyword, const std::vector<std::array<int, N>>& elements,
                    const std::vector<int>& entity_of, const std::vector<Entity>& entities) {
  if (elements.empty()) return;
  out << keyword << '\n' << elements.size() << '\n';
  for (size_t i = 0; i < elements.size(); ++i) {
    for (const int v : elements[i]) out << v + 1 << ' ';
    out << entities[entity_of[i]].tag << '\n';
  }
}

/// Medit text (version 2): the references are tags of curves and regions; names stand in comments.
void write_medit(const std::filesystem::path& path, const Mesh& mesh) {
  write_file_atomically(path, [&](std::ostream& stream) {
    TextWriter out(stream);
    out << "MeshVersionFormatted 2\n";
    if (!mesh.unit.empty()) out << "# lengths in " << mesh.unit << '\n';
    write_names(out, "curve", mesh.curves);
    write_names(out, "region", mesh.regions);
    out << "Dimension\n3\nVertices\n" << mesh.points.size() << '\n';
    for (const Vec3& p : mesh.points) out << p.x << ' ' << p.y << ' ' << p.z << " 0\n";
    write_elements(out, "Edges", mesh.lines, mesh.line_curve, mesh.curves);
    write_elements(out, "Triangles", mesh.triangles, mesh.triangle_region, mesh.regions);
    write_elements(out, "Quadrilaterals", mesh.quads, mesh.quad_region, mesh.regions);
    out << "End\n";
    out.flush();
  });
}

}  // namespace

MeshFormat medit_format() { return {{".mesh"}, "Medit", read_by<read_medit>, write_by<write_medit>}; }

}  // namespace delquad
