// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <array>
#include <ostream>
#include <set>

#include "geometry/mesh/element_nodes.h"
#include "io/boundary_chains.h"
#include "io/mesh_formats.h"
#include "io/mesh_io.h"

namespace delquad {
namespace {

/// The condition of Nek5000 that a curve's name is, such as "W" or "SYM"; others are "MSH", with a number.
std::string nek_condition(const std::string& name) {
  constexpr std::size_t kCode = 3;
  return name.size() <= kCode ? name : "MSH";
}

/// A curved side or a condition: element and side, numbered from 1, five values and a code.
struct NekSide {
  int element, side;
  std::array<double, 5> values;
  std::string code;
};

/// Nek5000's .re2, version 2 (Nek5000's manual, "Geometry data in .re2"; core/reader_re2.f): corners, middles
/// of curved sides, conditions of one field. All numbers are real and have this machine's order of bytes,
/// which the tag after the header tells.
void write_re2(const std::filesystem::path& path, const Mesh& mesh) {
  require_planar(path, "Nek5000's .re2", mesh);
  require_quads(path, "Nek5000's .re2", mesh);
  const std::vector<MeshGroup> groups = mesh_groups(mesh, {one_line_label});
  std::vector<NekSide> curves, conditions;
  for (std::size_t q = 0; q < mesh.quads.size() && mesh.order == 2; ++q)
    for (int k = 0; k < 4; ++k) {
      const Vec3& p = mesh.points[nodes_of_quad(mesh, q)[side_places(2, k)[0]]];
      const Vec3 ends = mesh.points[mesh.quads[q][k]] + mesh.points[mesh.quads[q][(k + 1) % 4]];
      if (p != 0.5 * ends) curves.push_back({static_cast<int>(q) + 1, k + 1, {p.x, p.y}, "m"});
    }
  for (const BoundarySide& side : boundary_sides(mesh, groups)) {
    const int number = side.group < 0 ? 0 : groups[side.group].number;
    conditions.push_back({side.element + 1,
                          side.side + 1,
                          {0, 0, 0, 0, static_cast<double>(number)},
                          side.group < 0 ? "MSH" : nek_condition(groups[side.group].name)});
  }
  write_file_atomically(path, [&](std::ostream& out) {
    const auto put = [&](const auto& value) {
      out.write(reinterpret_cast<const char*>(&value), sizeof value);
    };
    std::string header = fmt::format("#v002{0:9}{1:3}{0:9} quad mesh by Delquad", mesh.quads.size(), 2);
    constexpr std::size_t kHeader = 80;
    constexpr float kTag = 6.54321F;
    header.resize(kHeader, ' ');
    out << header;
    put(kTag);
    for (std::size_t q = 0; q < mesh.quads.size(); ++q) {
      put(static_cast<double>(mesh.regions[mesh.quad_region[q]].tag));
      for (const int v : mesh.quads[q]) put(mesh.points[v].x);
      for (const int v : mesh.quads[q]) put(mesh.points[v].y);
    }
    for (const std::vector<NekSide>& sides : {curves, conditions}) {
      put(static_cast<double>(sides.size()));
      for (const NekSide& side : sides) {
        put(static_cast<double>(side.element)), put(static_cast<double>(side.side));
        put(side.values);
        out << fmt::format("{:8}", side.code);
      }
    }
  });
}

/// The numbers of curves on the boundary whose names are no conditions.
std::vector<std::string> numbers_in_nek(const Mesh& mesh) {
  const std::vector<MeshGroup> groups = mesh_groups(mesh, {one_line_label});
  std::set<int> on_boundary;
  for (const BoundarySide& side : boundary_sides(mesh, groups)) on_boundary.insert(side.group);
  std::vector<std::string> all;
  for (const int g : on_boundary)
    if (g >= 0 && nek_condition(groups[g].name) == "MSH")
      all.push_back(fmt::format("curve \"{}\" is MSH with number {}", groups[g].label, groups[g].number));
  return all;
}

}  // namespace

MeshFormat re2_format() {
  return {.extensions = {".re2"},
          .description = "Nek5000",
          .write = write_by<write_re2>,
          .most_order = 2,
          .renamed = numbers_in_nek,
          .names = kBoundaryNames};
}

}  // namespace delquad
