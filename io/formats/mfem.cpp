#include <climits>

#include "geometry/mesh/element_nodes.h"
#include "io/formats/readers.h"
#include "io/mesh_formats.h"
#include "io/mesh_groups.h"
#include "io/mesh_io.h"
#include "io/text_writer.h"

namespace delquad {
namespace {

/// MFEM's own format (1.0): attributes are the numbers of names, which comments tell.
void write_mfem(const std::filesystem::path& path, const Mesh& mesh) {
  const auto row = static_cast<std::size_t>(mesh.order) + 1;
  require_fits(path, "MFEM", mesh.order == 1 ? 0 : 3 * row * row * mesh.quads.size(), "coordinates of nodes",
               INT_MAX);
  const std::vector<MeshGroup> groups = mesh_groups(mesh, {one_line_label});
  const std::vector<HalfEdge> sides = sorted_half_edges(mesh);
  const std::vector<int> attribute = group_numbers(groups, 2, mesh.triangles.size() + mesh.quads.size());
  const std::vector<int> of_lines = group_numbers(groups, 1, mesh.lines.size());
  const int dim = is_planar(mesh) ? 2 : 3;
  std::vector<std::size_t> boundary;
  for (std::size_t l = 0; l < mesh.lines.size(); ++l)
    if (sides_of_edge(sides, mesh.lines[l][0], mesh.lines[l][1]).size() == 1) boundary.push_back(l);
  // Curved meshes list the nodes of each element; vertices are the corners alone.
  std::vector<int> vertex(mesh.points.size(), -1);
  int n_vertices = 0;
  for_each_element(mesh, [&](int, const auto& v) {
    for (const int i : v) vertex[i] = 0;
  });
  for (int& v : vertex)
    if (v == 0) v = n_vertices++;
  constexpr int kSegment = 1, kTriangle = 2, kSquare = 3;
  write_file_atomically(path, [&](std::ostream& stream) {
    TextWriter out(stream);
    out << "MFEM mesh v1.0\n\n# quad mesh by Delquad\n";
    if (!mesh.unit.empty()) out << "# lengths in " << mesh.unit << '\n';
    for (const MeshGroup& group : groups)
      if (group.dim > 0)
        out << "# " << (group.dim == 1 ? "boundary " : "") << "attribute " << group.number << ": "
            << one_line(group.name) << '\n';
    out << "\ndimension\n2\n\nelements\n" << mesh.triangles.size() + mesh.quads.size() << '\n';
    const auto write = [&](int number, int geometry, const auto& nodes) {
      out << number << ' ' << geometry;
      for (const int v : nodes) out << ' ' << vertex[v];
      out << '\n';
    };
    for_each_element(
        mesh, [&](int e, const auto& v) { write(attribute[e], v.size() == 3 ? kTriangle : kSquare, v); });
    out << "\nboundary\n" << boundary.size() << '\n';
    for (const std::size_t l : boundary) write(of_lines[l], kSegment, mesh.lines[l]);
    const auto write_place = [&](const Vec3& p) {
      out << p.x << ' ' << p.y;
      if (dim == 3) out << ' ' << p.z;
      out << '\n';
    };
    out << "\nvertices\n" << n_vertices << '\n';
    if (mesh.order == 1) {
      out << dim << '\n';
      for (std::size_t i = 0; i < vertex.size(); ++i)
        if (vertex[i] >= 0) write_place(mesh.points[i]);
    } else {
      // Closed uniform points (type 4), as ours; the space knows no common nodes, but the places are the
      // same.
      out << "\nnodes\nFiniteElementSpace\nFiniteElementCollection: L2_T4_2D_P" << mesh.order
          << "\nVDim: " << dim << "\nOrdering: 1\n\n";
      for (std::size_t q = 0; q < mesh.quads.size(); ++q)
        for (const int v : nodes_of_quad(mesh, q)) write_place(mesh.points[v]);
    }
    out.flush();
  });
}

}  // namespace

MeshFormat mfem_format() {
  return {{".mfem"}, "MFEM 1.0", read_by<read_mfem>, write_by<write_mfem>, kMostOrder};
}

}  // namespace delquad
