// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <cmath>
#include <functional>

#include "geometry/mesh/element_nodes.h"
#include "io/boundary_chains.h"
#include "io/mesh_formats.h"
#include "io/mesh_io.h"
#include "io/text_writer.h"

namespace delquad {
namespace {

/// SPECFEM2D's sides of the model: 1 at the bottom, 2 to the right, 3 at the top, 4 to the left.
int specfem_side(const Mesh& mesh, const BoundarySide& side) {
  const Vec3 along = mesh.points[side.run[1]] - mesh.points[side.run[0]];
  if (std::abs(along.x) >= std::abs(along.y)) return along.x > 0 ? 1 : 3;
  return along.y > 0 ? 2 : 4;
}

/// Files of an external mesh for SPECFEM2D (its manual, chapter 3; meshfem2D/read_external_mesh_files.F90),
/// and lines for its Par_file that name them. Materials are numbers of names of regions.
void write_specfem(const std::filesystem::path& path, const Mesh& mesh) {
  require_planar(path, "SPECFEM2D", mesh);
  require_quads(path, "SPECFEM2D", mesh);
  const std::vector<MeshGroup> groups = mesh_groups(mesh, {one_line_label});
  const std::vector<BoundarySide> sides = boundary_sides(mesh, groups);
  const auto named = [&](std::string_view word) {
    std::vector<BoundarySide> found;
    for (const BoundarySide& side : sides)
      if (side.group >= 0 && name_contains(groups[side.group].name, word)) found.push_back(side);
    return found;
  };
  const std::vector<BoundarySide> free = named("free"), absorbing = named("absorb");
  const std::string stem = path.stem().string();
  std::vector<FileToWrite> files;
  std::string parameters = "# quad mesh by Delquad\nread_external_mesh = .true.\n";
  const auto add = [&](const char* key, const std::function<void(TextWriter&)>& write) {
    const std::string name = fmt::format("{}_{}", stem, key);
    parameters += fmt::format("{} = ./DATA/{}\n", key, name);
    files.push_back({path.parent_path() / name, as_text(write)});
  };
  add("mesh_file", [&](TextWriter& out) {
    out << mesh.quads.size() << '\n';
    const std::vector<int> places = gmsh_places(mesh.order);
    for (std::size_t q = 0; q < mesh.quads.size(); ++q) {
      const std::vector<int> nodes = nodes_of_quad(mesh, q, places);
      for (std::size_t k = 0; k < nodes.size(); ++k)
        out << nodes[k] + 1 << (k + 1 == nodes.size() ? '\n' : ' ');
    }
  });
  add("nodes_coords_file", [&](TextWriter& out) {
    out << mesh.points.size() << '\n';
    for (const Vec3& p : mesh.points) out << p.x << ' ' << p.y << '\n';
  });
  add("materials_file", [&](TextWriter& out) {
    for (const int number : group_numbers(mesh, groups, 2)) out << number << '\n';
  });
  add("free_surface_file", [&](TextWriter& out) {
    out << free.size() << '\n';
    for (const BoundarySide& side : free)
      out << side.element + 1 << " 2 " << side.run[0] + 1 << ' ' << side.run[1] + 1 << '\n';
  });
  add("absorbing_surface_file", [&](TextWriter& out) {
    out << absorbing.size() << '\n';
    for (const BoundarySide& side : absorbing)
      out << side.element + 1 << " 2 " << side.run[0] + 1 << ' ' << side.run[1] + 1 << ' '
          << specfem_side(mesh, side) << '\n';
  });
  parameters += fmt::format("NGNOD = {}\n", mesh.order == 2 ? 9 : 4);
  for (const MeshGroup& group : groups)
    if (group.dim == 2) parameters += fmt::format("# material {}: {}\n", group.number, group.label);
  files.push_back({path, [&](std::ostream& out) { out << parameters; }});
  write_files_atomically(files);
}

}  // namespace

MeshFormat specfem_format() {
  return {.extensions = {".specfem"},
          .description = "SPECFEM2D: five files and their lines of the Par_file",
          .write = write_by<write_specfem>,
          .most_order = 2,
          .names = kRegionNames};
}

}  // namespace delquad
