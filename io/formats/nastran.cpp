// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <cstddef>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "io/cell_view.h"
#include "io/formats/deck.h"
#include "io/formats/nastran_card.h"
#include "io/mesh_formats.h"
#include "io/text_writer.h"

namespace delquad {
namespace {

/// Comments that tell names: a property for each group of the highest dimension, SETs of the nodes of others.
void write_names(TextWriter& out, const Mesh& mesh, const std::vector<MeshGroup>& groups) {
  constexpr const char* kKinds[] = {"point ", "curve ", "face "};
  out << (is_solid(mesh) ? "$ volume mesh by Delquad\n" : "$ quad mesh by Delquad\n");
  if (!mesh.unit.empty()) out << "$ lengths in " << mesh.unit << '\n';
  std::size_t set = 0;
  for (const MeshGroup& group : groups) {
    if (group.dim == groups[0].dim) {
      out << "$ property " << group.number << ": " << one_line(group.name) << '\n';
      continue;
    }
    out << "$ set " << ++set << ", nodes of " << kKinds[group.dim] << one_line(group.name) << '\n';
    std::vector<long long> nodes;
    for (const int v : nodes_of_group(mesh, group)) nodes.push_back(v + 1);
    out << nastran_set(std::to_string(set), nodes);
  }
  out << "BEGIN BULK\n";
}

/// Gives elements a property for each thickness, to four digits, of each group. Writes PSHELL cards of
/// material 1.
void write_shells(TextWriter& out, const Mesh& mesh, std::vector<int>& property) {
  std::map<std::pair<int, std::string>, int> shells;
  std::set<int> taken(property.begin(), property.end()), used;
  for (std::size_t e = 0; e < mesh.thickness.size(); ++e) {
    const auto [at, is_new] =
        shells.try_emplace({property[e], fmt::format("{:.4g}", mesh.thickness[e])}, property[e]);
    if (is_new && !used.insert(at->second).second) taken.insert(at->second = *taken.rbegin() + 1);
    property[e] = at->second;
  }
  if (!shells.empty()) out << "$ material 1 is yours\n";
  for (const auto& [key, number] : shells)
    out << card_text("PSHELL",
                     {std::to_string(number), "1", nastran_number(std::stod(key.second)), "1", "", "1"});
}

/// Writes bulk data: CHEXA, CPENTA, CPYRAM and CTETRA, or CQUAD4, CQUAD8 and CTRIA3, with a property for each
/// name of elements. SETs hold the nodes of other names; comments tell the names.
void write_nastran(const std::filesystem::path& path, const Mesh& mesh) {
  using enum CellShape;
  constexpr CellCode<const char*> kCards[] = {{kTriangle, 3, "CTRIA3"},   {kQuad, 4, "CQUAD4"},
                                              {kQuad, 8, "CQUAD8"},       {kHexahedron, 8, "CHEXA"},
                                              {kPrism, 6, "CPENTA"},      {kPyramid, 5, "CPYRAM"},
                                              {kTetrahedron, 4, "CTETRA"}};
  require_numbers(path, "Nastran", mesh, kMostNastran);
  const std::vector<MeshGroup> groups = mesh_groups(mesh, {one_line_label});
  std::vector<int> property = group_numbers(mesh, groups, dimension_of(mesh));
  const std::vector<char> left_out = are_in_middles(mesh);
  write_text_file(path, [&](TextWriter& out) {
    write_names(out, mesh, groups);
    write_shells(out, mesh, property);
    for (std::size_t i = 0; i < mesh.points.size(); ++i)
      if (const Vec3& p = mesh.points[i]; !left_out[i])
        out << card_text("GRID", {std::to_string(i + 1), "", nastran_number(p.x), nastran_number(p.y),
                                  nastran_number(p.z)});
    std::size_t n = 0;
    for (const CellBlock& cells : cell_blocks(mesh, places_on_sides(mesh.order))) {
      if (cells.dim != dimension_of(mesh)) continue;
      for (std::size_t i = 0; i < cells.size(); ++i, ++n) {
        std::vector<std::string> numbers{std::to_string(n + 1), std::to_string(property[n])};
        for (const int v : cells.nodes(i)) numbers.push_back(std::to_string(v + 1));
        out << card_text(code_of(cells, kCards), std::move(numbers));
      }
    }
    out << "ENDDATA\n";
  });
}

}  // namespace

MeshFormat nastran_format() {
  return {.extensions = {".bdf", ".nas"},
          .description = "Nastran bulk data",
          .read =
              [](const std::filesystem::path& path, ReadNotes* notes, Strays) {
                Deck deck = read_nastran_deck(path, false);
                for (const auto& [other, count] : deck.others)
                  if (notes != nullptr && is_nastran_element(other)) notes->push_back(other + " is not read");
                return std::move(deck.mesh);
              },
          .write = write_by<write_nastran>,
          .most_order = 2,
          .has_cells = true,
          .has_shells = true,
          .eight_nodes = EightNodes::kAlways,
          .read_given = [](const std::filesystem::path& path,
                           ReadNotes* notes) { return given_mesh(read_nastran_deck(path, true), notes); },
          .rewrite = rewrite_nastran,
          .sections = nastran_sections,
          .add_sections = add_nastran_sections,
          .others = [](const std::filesystem::path& path) { return read_nastran_deck(path, false).others; }};
}

}  // namespace delquad
