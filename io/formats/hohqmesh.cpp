// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "geometry/mesh/element_nodes.h"
#include "io/boundary_chains.h"
#include "io/mesh_formats.h"
#include "io/mesh_io.h"
#include "io/text_writer.h"

namespace delquad {
namespace {

/// Trixi's symbols of boundaries, at most 32 characters.
constexpr UniqueLabels::Rules kHohqLabels{plain_label, false, 22};

/// The contents of HOHQMesh's formats: corners, curves of sides, and the names of sides. Sides 3 and 4 run
/// from corner 4 to 3 and from 1 to 4, as the element's coordinates do.
class HohqMesh {
 public:
  HohqMesh(const std::filesystem::path& path, const Mesh& mesh)
      : mesh_(mesh), number_(mesh.points.size(), 0), names_(mesh.quads.size(), {"---", "---", "---", "---"}) {
    require_planar(path, "HOHQMesh's format", mesh);
    require_quads(path, "HOHQMesh's format", mesh);
    for (const auto& quad : mesh.quads)
      for (const int v : quad) number_[v] = 1;
    for (std::size_t i = 0; i < number_.size(); ++i)
      if (number_[i] > 0) corners_.push_back(mesh.points[i]), number_[i] = static_cast<int>(corners_.size());
    const std::vector<MeshGroup> groups = mesh_groups(mesh, kHohqLabels);
    for (const BoundarySide& side : boundary_sides(mesh, groups))
      names_[side.element][side.side] = side.group < 0 ? "boundary" : groups[side.group].label;
  }

  const std::vector<Vec3>& corners() const { return corners_; }
  int number(int point) const { return number_[point]; }
  const std::array<std::string, 4>& names(std::size_t quad) const { return names_[quad]; }

  void write_corners(TextWriter& out, std::size_t quad, std::string_view separator) const {
    for (int k = 0; k < 4; ++k) out << (k == 0 ? "" : separator) << number_[mesh_.quads[quad][k]];
    out << '\n';
  }
  /// Which sides are curved, and the points of those: at the Chebyshev-Lobatto points -cos(j pi / order).
  void write_curves(TextWriter& out, std::size_t quad, std::string_view before) const {
    std::array<std::vector<Vec3>, 4> curves;
    for (int k = 0; k < 4; ++k) curves[k] = curve(quad, k);
    out << before;
    for (int k = 0; k < 4; ++k) out << (k == 0 ? "" : " ") << (curves[k].empty() ? 0 : 1);
    out << '\n';
    for (const std::vector<Vec3>& points : curves)
      for (const Vec3& p : points) out << before << p.x << ' ' << p.y << " 0.0\n";
  }

 private:
  /// Empty where the side is straight. Both elements of a side have the same digits.
  std::vector<Vec3> curve(std::size_t quad, int side) const {
    const std::vector<int> square = nodes_of_quad(mesh_, quad);
    std::vector<int> nodes{mesh_.quads[quad][side]};
    for (const int place : side_places(mesh_.order, side)) nodes.push_back(square[place]);
    nodes.push_back(mesh_.quads[quad][(side + 1) % 4]);
    const bool turn = nodes.front() > nodes.back();
    if (turn) std::ranges::reverse(nodes);
    std::vector<Vec3> places, points;
    for (const int v : nodes) places.push_back(mesh_.points[v]);
    if (is_straight(places)) return {};
    for (int j = 0; j <= mesh_.order; ++j)
      points.push_back(value_on_line(places, 0.5 - 0.5 * std::cos(j * std::numbers::pi / mesh_.order)));
    if (turn != (side >= 2)) std::ranges::reverse(points);
    return points;
  }
  static bool is_straight(const std::vector<Vec3>& places) {
    constexpr double kRounding = 1e-13;  // of the side's length
    const Vec3 all = places.back() - places[0];
    for (std::size_t k = 1; k + 1 < places.size(); ++k) {
      const Vec3 straight = (static_cast<double>(k) / static_cast<double>(places.size() - 1)) * all;
      if (norm(places[k] - places[0] - straight) > kRounding * norm(all)) return false;
    }
    return true;
  }

  const Mesh& mesh_;
  std::vector<int> number_;  ///< of each point from 1 on; 0: it is no corner
  std::vector<Vec3> corners_;
  std::vector<std::array<std::string, 4>> names_;
};

/// ISM-V2 (HOHQMesh's documentation, "The HOHQMesh Mesh File Formats"). Edges: Kopriva [2009], algorithm 148.
void write_ism(const std::filesystem::path& path, const Mesh& mesh) {
  const HohqMesh all(path, mesh);
  const std::vector<HalfEdge> sides = sorted_half_edges(mesh);
  std::size_t n_edges = 0;
  for_each_edge(sides, [&](auto) { ++n_edges; });
  write_text_file(path, [&](TextWriter& out) {
    out << "ISM-V2\n"
        << all.corners().size() << ' ' << n_edges << ' ' << mesh.quads.size() << ' ' << mesh.order << '\n';
    for (const Vec3& p : all.corners()) out << p.x << ' ' << p.y << " 0.0\n";
    for_each_edge(sides, [&](std::span<const HalfEdge> at) {
      const auto place = [&](const HalfEdge& side) { return cell_side(mesh, side).side; };
      // Sides 0 and 1 run as the element does, 2 and 3 against it.
      const auto start = [&](const HalfEdge& side) { return side.run()[place(side) < 2 ? 0 : 1]; };
      out << all.number(start(at[0])) << ' ' << all.number(at[0].lo + at[0].hi - start(at[0])) << ' '
          << at[0].element + 1 << ' ';
      if (at.size() == 1)
        out << "0 " << place(at[0]) + 1 << " 0\n";
      else
        out << at[1].element + 1 << ' ' << place(at[0]) + 1 << ' '
            << (start(at[0]) == start(at[1]) ? 1 : -1) * (place(at[1]) + 1) << '\n';
    });
    for (std::size_t q = 0; q < mesh.quads.size(); ++q) {
      all.write_corners(out, q, " ");
      all.write_curves(out, q, "");
      for (int k = 0; k < 4; ++k) out << all.names(q)[k] << (k == 3 ? '\n' : ' ');
    }
  });
}

/// Abaqus with HOHQMesh's comments, which Trixi knows by the second line; names in p4est's order of sides.
void write_hohqmesh_abaqus(const std::filesystem::path& path, const Mesh& mesh) {
  const HohqMesh all(path, mesh);
  write_text_file(path, [&](TextWriter& out) {
    out << "*Heading\n File created by HOHQMesh\n*NODE\n";
    for (std::size_t i = 0; i < all.corners().size(); ++i)
      out << i + 1 << ", " << all.corners()[i].x << ", " << all.corners()[i].y << ", 0.0\n";
    out << "*ELEMENT, type=CPS4, ELSET=Surface1\n";
    for (std::size_t q = 0; q < mesh.quads.size(); ++q) {
      out << q + 1 << ", ";
      all.write_corners(out, q, ", ");
    }
    out << "** ***** HOHQMesh boundary information ***** **\n** mesh polynomial degree = " << mesh.order
        << '\n';
    for (std::size_t q = 0; q < mesh.quads.size(); ++q) {
      out << "** ";
      all.write_corners(out, q, " ");
      all.write_curves(out, q, "** ");
    }
    for (std::size_t q = 0; q < mesh.quads.size(); ++q) {
      out << "**";
      for (const int k : {3, 1, 0, 2}) out << ' ' << all.names(q)[k];
      out << '\n';
    }
  });
}

std::vector<std::string> renamed_by_hohqmesh(const Mesh& mesh) {
  std::vector<MeshGroup> groups = mesh_groups(mesh, kHohqLabels);
  std::erase_if(groups, [](const MeshGroup& group) { return group.dim != 1; });
  return renamed_groups(groups);
}

}  // namespace

MeshFormat ism_format() {
  return {.extensions = {".ism"},
          .description = "HOHQMesh's ISM-V2: Trixi's UnstructuredMesh2D",
          .write = write_by<write_ism>,
          .most_order = kMostOrder,
          .renamed = renamed_by_hohqmesh,
          .names = kBoundaryNames};
}
MeshFormat hohqmesh_abaqus_format() {
  return {.extensions = {".abq"},
          .description = "Abaqus with HOHQMesh's curves: Trixi's P4estMesh",
          .write = write_by<write_hohqmesh_abaqus>,
          .most_order = kMostOrder,
          .renamed = renamed_by_hohqmesh,
          .names = kBoundaryNames};
}

}  // namespace delquad
