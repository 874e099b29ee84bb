#include "base/located.h"
#include "io/boundary_chains.h"
#include "io/entity_names.h"
#include "io/formats/numbered_mesh.h"
#include "io/mesh_formats.h"
#include "io/mesh_io.h"
#include "io/text_writer.h"

namespace delquad {
namespace {

/// SCHISM's hgrid.gr3 (its manual, "Horizontal grid"), depth 0 everywhere. ADCIRC's fort.14 is the same, of
/// triangles.
void write_gr3(const std::filesystem::path& path, const Mesh& mesh) {
  if (kind_of_file(path) != ".gr3" && !mesh.quads.empty())
    refuse(
        "{}: ADCIRC has triangles only, and there are {} quads: expected triangles, of --pipeline D, or "
        ".gr3, for SCHISM, which has both",
        path.string(), mesh.quads.size());
  require_planar(path, "SCHISM's and ADCIRC's grid", mesh);
  const std::vector<CoastPiece> pieces = coast_pieces(mesh);
  write_text_file(path, [&](TextWriter& out) {
    out << "quad mesh by Delquad" << (mesh.unit.empty() ? "" : ", lengths in " + mesh.unit) << '\n'
        << mesh.triangles.size() + mesh.quads.size() << ' ' << mesh.points.size() << '\n';
    for (std::size_t i = 0; i < mesh.points.size(); ++i)
      out << i + 1 << ' ' << mesh.points[i].x << ' ' << mesh.points[i].y << " 0\n";
    for_each_element(mesh, [&](int e, const auto& v) {
      out << e + 1 << ' ' << v.size();
      for (const int i : v) out << ' ' << i + 1;
      out << '\n';
    });
    for (const bool open : {true, false}) {
      const char* const kind = open ? "open" : "land";
      std::size_t n_pieces = 0, n_nodes = 0;
      for (const CoastPiece& piece : pieces)
        if (piece.open == open) ++n_pieces, n_nodes += piece.nodes.size();
      out << n_pieces << " = number of " << kind << " boundaries\n"
          << n_nodes << " = total number of " << kind << " boundary nodes\n";
      for (const CoastPiece& piece : pieces) {
        if (piece.open != open) continue;
        out << piece.nodes.size()
            << (open           ? ""
                : piece.island ? " 1"
                               : " 0")
            << " = number of nodes of " << (piece.island ? "island" : kind) << " boundary " << piece.name
            << '\n';
        for (const int v : piece.nodes) out << v + 1 << '\n';
      }
    }
  });
}

/// Its triangles and quads. Depths and boundaries are left out.
Mesh read_gr3(const std::filesystem::path& path, ReadNotes* notes, Strays) {
  TextScanner in(path);
  in.rest_of_line();  // a title
  const long long n_elements = in.count("the number of elements"), n_nodes = in.count("the number of nodes");
  in.rest_of_line();
  NumberedMesh mesh;
  for (long long i = 0; i < n_nodes; ++i, in.rest_of_line()) mesh.read_node(in);
  for (long long i = 0; i < n_elements; ++i, in.rest_of_line()) {
    in.integer("an element's number", 0, LLONG_MAX);
    mesh.read_corners(in, in.integer("a number of corners", 3, 4));
  }
  if (!in.at_end() && notes != nullptr) notes->push_back("boundaries are left out");
  return mesh.finished(in);
}

}  // namespace

MeshFormat gr3_format() {
  return {.extensions = {".gr3", ".14", ".grd"},
          .description = "SCHISM; ADCIRC's fort.14, of triangles",
          .read = read_gr3,
          .write = write_by<write_gr3>,
          .names = kBoundaryNames};
}

}  // namespace delquad
