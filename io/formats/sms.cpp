// SPDX-License-Identifier: GPL-3.0-or-later
#include <cctype>

#include "base/text.h"
#include "io/boundary_chains.h"
#include "io/formats/numbered_mesh.h"
#include "io/mesh_formats.h"
#include "io/mesh_io.h"
#include "io/text_writer.h"

namespace delquad {
namespace {

/// The node strings of SMS: the lines of each curve, on the boundary with the mesh on their left.
std::vector<std::pair<std::string, std::vector<int>>> node_strings(const Mesh& mesh,
                                                                   const std::vector<MeshGroup>& groups) {
  const std::vector<HalfEdge> sides = sorted_half_edges(mesh);
  std::vector<std::pair<std::string, std::vector<int>>> strings;
  for (const MeshGroup& group : groups) {
    if (group.dim != 1) continue;
    std::vector<std::array<int, 2>> runs;
    for (const int l : group.items) {
      const auto at = sides_of_edge(sides, mesh.lines[l][0], mesh.lines[l][1]);
      runs.push_back(at.size() == 1 ? at[0].run() : mesh.lines[l]);
    }
    for (std::vector<int>& nodes : join_edges(runs)) strings.emplace_back(group.name, std::move(nodes));
  }
  return strings;
}

/// SMS's two-dimensional mesh, as Aquaveo's wiki has it ("2D Mesh Files *.2dm"): one material for each name
/// of regions. A node string is one line with its name behind the last node, which is negative, as Basement
/// and TUFLOW FV want it.
void write_sms(const std::filesystem::path& path, const Mesh& mesh) {
  require_terrain(path, "SMS's .2dm", mesh);
  const std::vector<MeshGroup> groups = mesh_groups(mesh, {one_line_label});
  const std::vector<int> material = group_numbers(mesh, groups, 2);
  const auto strings = node_strings(mesh, groups);
  std::vector<UniqueLabels::Key> keys;
  for (const auto& [name, nodes] : strings) keys.emplace_back(static_cast<int>(keys.size()), name);
  const UniqueLabels labels(keys, {word_label});
  write_text_file(path, [&](TextWriter& out) {
    out << "MESH2D\nMESHNAME \"quad mesh by Delquad\"\nNUM_MATERIALS_PER_ELEM 1\n";
    for_each_element(mesh, [&](int e, const auto& v) {
      out << (v.size() == 3 ? "E3T " : "E4Q ") << e + 1;
      for (const int i : v) out << ' ' << i + 1;
      out << ' ' << material[e] << '\n';
    });
    for (std::size_t i = 0; i < mesh.points.size(); ++i) {
      const Vec3& p = mesh.points[i];
      out << "ND " << i + 1 << ' ' << p.x << ' ' << p.y << ' ' << p.z << '\n';
    }
    for (std::size_t s = 0; s < strings.size(); ++s) {
      const std::vector<int>& nodes = strings[s].second;
      out << "NS";
      for (const int& v : nodes) out << ' ' << (&v == &nodes.back() ? -v - 1 : v + 1);
      out << ' ' << labels.of(keys[s]) << '\n';
    }
    out << "BEGPARAMDEF\n";
    for (const MeshGroup& group : groups)
      if (group.dim == 2) out << "MAT " << group.number << " \"" << group.label << "\"\n";
    out << "ENDPARAMDEF\n";
  });
}

/// Its triangles, quads and materials with their names. Depths and node strings are left out.
Mesh read_sms(const std::filesystem::path& path, ReadNotes* notes, Strays) {
  TextScanner in(path);
  if (in.token("MESH2D") != "MESH2D") in.fail("expected MESH2D");
  NumberedMesh mesh;
  NumberedEntities materials;
  for (in.rest_of_line(); !in.at_end(); in.rest_of_line()) {
    const std::string_view card = in.token("a card");
    if (card == "ND") {
      mesh.read_node(in);
    } else if (card == "E3T" || card == "E4Q") {
      in.integer("an element's number", 0, LLONG_MAX);
      mesh.read_corners(in, card == "E3T" ? 3 : 4);
      if (!in.at_end_of_line()) mesh.set_material(in.integer("a material", 0, NumberedEntities::kMostNumber));
    } else if (card == "MAT") {
      const std::string number(in.token("a material's number"));
      std::string name(trimmed(in.rest_of_line()));
      std::erase(name, '"');
      materials.take_name(number + ": " + name, "", ": ", 2);
    } else if (card.starts_with("E") && card.size() == 3 &&
               std::isdigit(static_cast<unsigned char>(card[1]))) {
      in.fail("elements {}: expected triangles E3T and quads E4Q", TextScanner::printable(card));
    } else if (card == "NS" && notes != nullptr && notes->empty()) {
      notes->push_back("node strings are left out");
    }
  }
  return mesh.finished(in, std::move(materials));
}

}  // namespace

MeshFormat sms_format() {
  return {.extensions = {".2dm"},
          .description = "SMS: TUFLOW FV, Basement, QGIS",
          .read = read_sms,
          .write = write_by<write_sms>,
          .has_depths = true,
          .names = kAllNames & ~kPointNames};
}

}  // namespace delquad
