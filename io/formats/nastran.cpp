#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "io/cell_view.h"
#include "io/formats/deck.h"
#include "io/mesh_formats.h"
#include "io/text_writer.h"

namespace delquad {
namespace {

constexpr std::size_t kSmallField = 8, kLargeField = 16;

/// Left-aligned in a field of eight characters.
std::string field(const std::string& text) {
  return text + std::string(kSmallField - std::min(text.size(), kSmallField), ' ');
}
std::string field(std::size_t number) { return field(std::to_string(number)); }

/// Eight fields to a line; further ones on continuations.
void write_card(TextWriter& out, const char* name, const std::vector<std::size_t>& numbers) {
  out << field(name);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (i > 0 && i % 8 == 0) out << '\n' << field("");
    out << field(numbers[i]);
  }
  out << '\n';
}

void write_grid(TextWriter& out, std::size_t i, const Vec3& p) {
  const std::string id = std::to_string(i + 1);
  out << "GRID*   " << id << std::string(kLargeField - id.size(), ' ') << std::string(kLargeField, ' ')
      << nastran_number(p.x) << nastran_number(p.y) << "\n*       " << nastran_number(p.z) << '\n';
}

/// Comments that tell names: a property for each group of the highest dimension, SETs of the nodes of others.
void write_names(TextWriter& out, const Mesh& mesh, const std::vector<MeshGroup>& groups) {
  constexpr const char* kKinds[] = {"point ", "curve ", "face "};
  out << (mesh.hexahedra.empty() ? "$ quad mesh by Delquad\n" : "$ mesh of hexahedra by Delquad\n");
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

/// Writes bulk data: CHEXA, or CQUAD4, CQUAD8 and CTRIA3, with a property for each name of elements. SETs
/// hold the nodes of other names; comments tell the names.
void write_nastran(const std::filesystem::path& path, const Mesh& mesh) {
  using enum CellShape;
  constexpr CellCode<const char*> kCards[] = {
      {kTriangle, 3, "CTRIA3"}, {kQuad, 4, "CQUAD4"}, {kQuad, 8, "CQUAD8"}, {kHexahedron, 8, "CHEXA"}};
  require_numbers(path, "Nastran", mesh, kMostNastran);
  const std::vector<MeshGroup> groups = mesh_groups(mesh, {one_line_label});
  const std::vector<int> property = group_numbers(mesh, groups, dimension_of(mesh));
  const std::vector<char> left_out = are_in_middles(mesh);
  write_text_file(path, [&](TextWriter& out) {
    write_names(out, mesh, groups);
    for (std::size_t i = 0; i < mesh.points.size(); ++i)
      if (!left_out[i]) write_grid(out, i, mesh.points[i]);
    std::size_t n = 0;
    for (const CellBlock& cells : cell_blocks(mesh, places_on_sides(mesh.order))) {
      if (cells.dim != dimension_of(mesh)) continue;
      for (std::size_t i = 0; i < cells.size(); ++i, ++n) {
        std::vector<std::size_t> numbers{n + 1, static_cast<std::size_t>(property[n])};
        for (const int v : cells.nodes(i)) numbers.push_back(static_cast<std::size_t>(v) + 1);
        write_card(out, code_of(cells, kCards), numbers);
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
          .has_hexahedra = true,
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
