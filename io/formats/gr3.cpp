// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <utility>

#include "base/located.h"
#include "base/text.h"
#include "io/boundary_chains.h"
#include "io/formats/numbered_mesh.h"
#include "io/mesh_formats.h"
#include "io/mesh_io.h"
#include "io/text_writer.h"

namespace delquad {
namespace {

/// Nodes on both sides of a weir, which are there twice.
using NodePairs = std::vector<std::array<int, 2>>;

/// The pairs of each piece whose name contains "weir", in its order; a pair stands in the first piece of
/// both.
std::vector<NodePairs> weir_pairs(const Mesh& mesh, const std::vector<CoastPiece>& pieces) {
  std::map<std::pair<double, double>, std::set<int>> nodes_at;
  const auto at = [&](int v) { return std::pair(mesh.points[v].x, mesh.points[v].y); };
  for (const CoastPiece& piece : pieces)
    if (name_contains(piece.name, "weir"))
      for (const int v : piece.nodes) nodes_at[at(v)].insert(v);
  std::vector<NodePairs> pairs(pieces.size());
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    std::vector<int> nodes = pieces[p].nodes;
    if (!name_contains(pieces[p].name, "weir")) continue;
    if (pieces[p].island)  // from a tip on
      std::ranges::rotate(nodes,
                          std::ranges::find_if(nodes, [&](int v) { return nodes_at[at(v)].size() == 1; }));
    for (const int v : nodes) {
      std::set<int>& both = nodes_at[at(v)];
      if (both.size() == 2) pairs[p].push_back({v, *both.begin() == v ? *both.rbegin() : *both.begin()});
      both.clear();
    }
  }
  return pairs;
}

/// The height of a weir's crest, the number at the end of its name: 2.5 of "dam_weir_2.5".
double crest_of(const std::string& name) {
  const std::size_t number = name.find_last_not_of("0123456789.+-eE");
  return as_number(name.substr(number == std::string::npos ? 0 : number + 1)).value_or(0);
}

/// SCHISM's hgrid.gr3 (its manual, "Horizontal grid"); depths are z downwards. ADCIRC's fort.14 is the same,
/// of triangles, with weirs as pairs of nodes (its manual, IBTYPE 24).
void write_gr3(const std::filesystem::path& path, const Mesh& mesh) {
  const bool is_adcirc = kind_of_file(path) != ".gr3";
  require_terrain(path, "SCHISM's and ADCIRC's grid", mesh);
  std::vector<CoastPiece> pieces = coast_pieces(mesh);
  const std::vector<NodePairs> pairs =
      is_adcirc ? weir_pairs(mesh, pieces) : std::vector<NodePairs>(pieces.size());
  write_text_file(path, [&](TextWriter& out) {
    out << "quad mesh by Delquad" << (mesh.unit.empty() ? "" : ", lengths in " + mesh.unit) << '\n'
        << mesh.triangles.size() + mesh.quads.size() << ' ' << mesh.points.size() << '\n';
    for (std::size_t i = 0; i < mesh.points.size(); ++i)
      out << i + 1 << ' ' << mesh.points[i].x << ' ' << mesh.points[i].y << ' ' << 0 - mesh.points[i].z
          << '\n';
    for_each_element(mesh, [&](int e, const auto& v) {
      out << e + 1 << ' ' << v.size();
      for (const int i : v) out << ' ' << i + 1;
      out << '\n';
    });
    for (const bool open : {true, false}) {
      const char* const kind = open ? "open" : "land";
      std::size_t n_pieces = 0, n_nodes = 0;
      const auto is_written = [&](std::size_t p) {
        const bool is_other_side = is_adcirc && name_contains(pieces[p].name, "weir") && pairs[p].empty();
        return pieces[p].open == open && !is_other_side;
      };
      for (std::size_t p = 0; p < pieces.size(); ++p)
        if (is_written(p))
          ++n_pieces, n_nodes += pairs[p].empty() ? pieces[p].nodes.size() : 2 * pairs[p].size();
      out << n_pieces << " = number of " << kind << " boundaries\n"
          << n_nodes << " = total number of " << kind << " boundary nodes\n";
      for (std::size_t p = 0; p < pieces.size(); ++p) {
        const CoastPiece& piece = pieces[p];
        if (!is_written(p)) continue;
        if (!pairs[p].empty()) {
          out << pairs[p].size() << " 24 = number of pairs of nodes of weir " << piece.name << '\n';
          for (const auto& [v, w] : pairs[p])
            out << v + 1 << ' ' << w + 1 << ' ' << crest_of(piece.name) << " 1 1\n";
          continue;
        }
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
          .has_depths = true,
          .has_open_sides = true,
          .names = kBoundaryNames,
          .of_triangles = {".14", ".grd"}};
}

}  // namespace delquad
