// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <map>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include "base/located.h"
#include "io/cell_view.h"
#include "io/mesh_formats.h"
#include "io/mesh_io.h"
#include "io/text_writer.h"

namespace delquad {
namespace {

/// Tells the settings that SU2 has for periodic markers: center, angles in degrees, shift.
void write_periodic(TextWriter& out, const Mesh& mesh, const std::vector<MeshGroup>& groups) {
  std::map<int, std::string> label_of;  // by curve
  for (const MeshGroup& group : groups)
    for (const int l : group.items) label_of[mesh.line_curve[l]] = group.label;
  std::set<std::string> written;
  for (const PeriodicNodes& pair : mesh.periodic) {
    const auto from = label_of.find(pair.master), to = label_of.find(pair.curve);
    if (from == label_of.end() || to == label_of.end()) continue;
    const auto& [shift, angle, centre, axis] = pair.motion;
    const double turn = angle * 180 / std::numbers::pi * (axis.z < 0 ? -1 : 1);
    const std::string line = fmt::format("{}, {}, {}, {}, 0, 0, 0, {}, {}, {}, 0", from->second, to->second,
                                         centre.x, centre.y, turn, shift.x, shift.y);
    if (written.insert(line).second) out << "% MARKER_PERIODIC= ( " << line << " )\n";
  }
}

/// Writes elements, and a marker for each group of sides around the mesh: the solver takes no sides inside.
void write_su2(const std::filesystem::path& path, const Mesh& mesh) {
  using enum CellShape;
  constexpr CellCode<int> kVtkTypes[] = {{kLine, 2, 3},        {kTriangle, 3, 5},         {kQuad, 4, 9},
                                         {kHexahedron, 8, 12}, {kPrism, 6, 13, "021354"}, {kPyramid, 5, 14},
                                         {kTetrahedron, 4, 10}};
  const int dim = dimension_of(mesh);
  if (dim == 2 && !is_planar(mesh))
    refuse("{}: SU2 computes in planar meshes or in volumes: this is a surface in space [planar-format]",
           path.string());
  const CellSides sides(mesh);
  std::vector<MeshGroup> groups = mesh_groups(mesh, {plain_label});
  std::erase_if(groups, [&](const MeshGroup& group) { return group.dim != dim - 1; });
  for (MeshGroup& group : groups)
    std::erase_if(group.items, [&](int side) { return sides.at(side).size() != 1; });
  std::erase_if(groups, [](const MeshGroup& group) { return group.items.empty(); });
  const std::vector<CellBlock> blocks = cell_blocks(mesh);
  write_text_file(path, [&](TextWriter& out) {
    out << "% " << (dim == 3 ? "volume mesh" : "quad mesh") << " by Delquad\n";
    if (!mesh.unit.empty()) out << "% lengths in " << mesh.unit << '\n';
    for (const std::string& line : renamed_groups(groups)) out << "% " << line << '\n';
    if (dim == 2) write_periodic(out, mesh, groups);
    const auto write = [&](const CellBlock& cells, std::size_t i) {
      out << code_of(cells, kVtkTypes);
      for (const int v : nodes_of(cells, i, kVtkTypes)) out << ' ' << v;
    };
    out << "NDIME= " << dim << "\nNELEM= " << n_cells(mesh, dim) << '\n';
    for (const CellBlock& cells : blocks)
      for (std::size_t i = 0; i < cells.size() && cells.dim == dim; ++i) {
        write(cells, i);
        out << ' ' << cells.first + i << '\n';
      }
    out << "NPOIN= " << mesh.points.size() << '\n';
    for (std::size_t i = 0; i < mesh.points.size(); ++i) {
      out << mesh.points[i].x << ' ' << mesh.points[i].y << ' ';
      if (dim == 3) out << mesh.points[i].z << ' ';
      out << i << '\n';
    }
    out << "NMARK= " << groups.size() << '\n';
    for (const MeshGroup& group : groups) {
      out << "MARKER_TAG= " << group.label << "\nMARKER_ELEMS= " << group.items.size() << '\n';
      for (const CellBlock& cells : blocks)
        for (const std::size_t i : items_in_block(group, cells)) {
          write(cells, i);
          out << '\n';
        }
    }
  });
}

}  // namespace

MeshFormat su2_format() {
  return {.extensions = {".su2"},
          .description = "SU2",
          .write = write_by<write_su2>,
          .has_cells = true,
          .names = kBoundaryNames | kPeriodicPairs};
}

}  // namespace delquad
