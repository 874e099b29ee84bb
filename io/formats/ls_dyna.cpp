// SPDX-License-Identifier: GPL-3.0-or-later
#include <charconv>

#include "io/cell_view.h"
#include "io/mesh_formats.h"
#include "io/mesh_io.h"
#include "io/text_writer.h"

namespace delquad {

namespace {

/// Right-aligned in a field.
std::string right(const std::string& text, std::size_t width) {
  return std::string(width - std::min(width, text.size()), ' ') + text;
}

/// As many digits as the field of sixteen characters holds.
std::string coordinate_text(double x) {
  constexpr std::size_t kField = 16;
  char digits[48];
  for (int n = 16; n > 0; --n) {
    const std::string text(
        digits, std::to_chars(digits, digits + sizeof digits, x, std::chars_format::general, n).ptr);
    if (text.size() < kField) return right(text, kField);
  }
  return right("0", kField);
}

/// LS-DYNA's keywords: shells, a part for each name of regions, node sets of curves and points, all with
/// their titles.
void write_ls_dyna(const std::filesystem::path& path, const Mesh& mesh) {
  constexpr std::size_t kField = 8, kTenth = 10;
  require_numbers(path, "LS-DYNA", mesh, 99'999'999);
  const std::vector<MeshGroup> groups = mesh_groups(mesh, {one_line_label});
  const std::vector<int> part = group_numbers(mesh, groups, 2);
  write_text_file(path, [&](TextWriter& out) {
    const auto number = [](auto n, std::size_t width) { return right(std::to_string(n), width); };
    out << "*KEYWORD\n$ quad mesh by Delquad\n";
    if (!mesh.unit.empty()) out << "$ lengths in " << mesh.unit << '\n';
    for (const std::string& line : renamed_groups(groups)) out << "$ " << line << '\n';
    out << "*NODE\n";
    for (std::size_t i = 0; i < mesh.points.size(); ++i) {
      const Vec3& p = mesh.points[i];
      out << number(i + 1, kField) << coordinate_text(p.x) << coordinate_text(p.y) << coordinate_text(p.z)
          << '\n';
    }
    for (const MeshGroup& group : groups)
      if (group.dim == 2) out << "*PART\n" << group.label << '\n' << number(group.number, kTenth) << '\n';
    out << "*ELEMENT_SHELL\n";
    for_each_element(mesh, [&](int e, const auto& v) {
      out << number(e + 1, kField) << number(part[e], kField);
      for (std::size_t k = 0; k < 4; ++k) out << number(v[std::min(k, v.size() - 1)] + 1, kField);
      out << '\n';
    });
    int set = 0;
    for (const MeshGroup& group : groups) {
      if (group.dim == 2) continue;
      const std::vector<int> nodes = nodes_of_group(mesh, group);
      out << "*SET_NODE_LIST_TITLE\n" << group.label << '\n' << number(++set, kTenth) << '\n';
      for (std::size_t i = 0; i < nodes.size(); ++i)
        out << number(nodes[i] + 1, kTenth)
            << (i + 1 == nodes.size() || i % kField == kField - 1 ? "\n" : "");
    }
    out << "*END\n";
  });
}

}  // namespace

MeshFormat ls_dyna_format() { return {{".k", ".key"}, "LS-DYNA keywords", nullptr, write_by<write_ls_dyna>}; }

}  // namespace delquad
