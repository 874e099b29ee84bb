#include "features/extrusion/section.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <utility>

#include "base/text.h"
#include "delquad/error.h"
#include "geometry/mesh/check_mesh.h"
#include "geometry/mesh/drop_unused_points.h"
#include "geometry/mesh/half_edges.h"
#include "geometry/mesh/keep_elements.h"

namespace delquad {

namespace {

void require_quads(const Mesh& mesh) {
  if (mesh.order > 1)
    throw InputError(
        fmt::format("the mesh has elements of order {}: only quads of order 1 are swept", mesh.order));
  require_readable(mesh, "the mesh");
  if (!mesh.triangles.empty())
    throw InputError(fmt::format("the mesh has {} triangles beside {} quads: only meshes of quads are swept",
                                 mesh.triangles.size(), mesh.quads.size()));
  if (mesh.quads.empty()) throw InputError("the mesh has no quads to sweep");
  for (const auto& quad : mesh.quads)
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < i; ++j)
        if (quad[i] == quad[j])
          throw InputError(
              fmt::format("a quad has the node at {} for two corners", show_point(mesh.points[quad[i]])));
}

/// Turns quads over that run along an edge in the same direction as a neighbour that came first.
void orient(Section& section, std::span<const HalfEdge> sides) {
  std::vector<std::array<int, 4>>& quads = section.mesh.quads;
  const std::vector<Vec3>& points = section.mesh.points;
  struct Neighbour {
    int quad;
    bool is_turned;
    int a, b;
  };
  std::vector<std::vector<Neighbour>> neighbours(quads.size());
  for_each_edge(sides, [&](std::span<const HalfEdge> at) {
    if (at.size() > 2)
      throw InputError(
          fmt::format("{} quads share the edge at {}: only surfaces whose edges have one or two are swept",
                      at.size(), show_point(0.5 * (points[at[0].lo] + points[at[0].hi]))));
    if (at.size() < 2) return;
    const bool is_turned = at[0].forward == at[1].forward;
    neighbours[at[0].element].push_back({at[1].element, is_turned, at[0].lo, at[0].hi});
    neighbours[at[1].element].push_back({at[0].element, is_turned, at[0].lo, at[0].hi});
  });
  section.part.assign(quads.size(), -1);
  std::vector<char> turned(quads.size(), 0);
  std::vector<int> waiting;
  for (std::size_t first = 0; first < quads.size(); ++first) {
    if (section.part[first] >= 0) continue;
    section.part[first] = section.n_parts++;
    waiting.push_back(static_cast<int>(first));
    while (!waiting.empty()) {
      const int q = waiting.back();
      waiting.pop_back();
      for (const Neighbour& next : neighbours[q]) {
        const char wanted = turned[q] != static_cast<char>(next.is_turned);
        if (section.part[next.quad] < 0) {
          section.part[next.quad] = section.part[q];
          turned[next.quad] = wanted;
          waiting.push_back(next.quad);
        } else if (turned[next.quad] != wanted) {
          throw InputError(fmt::format(
              "the surface has one side only, as a Moebius strip, and cannot be swept: see the edge at {}",
              show_point(0.5 * (points[next.a] + points[next.b]))));
        }
      }
    }
  }
  for (std::size_t q = 0; q < quads.size(); ++q)
    if (turned[q]) std::swap(quads[q][1], quads[q][3]);
}

/// Takes out lines that are no edges of quads, and points that no quad has.
void drop_strange(Mesh& mesh, std::span<const HalfEdge> sides, ReadNotes* notes) {
  const std::size_t lines = drop_stray_lines(mesh, sides), names = mesh.named_points.size();
  drop_unused_points(mesh);
  if (notes == nullptr) return;
  if (lines > 0) notes->push_back(fmt::format("{} lines are no edges of quads and were left out", lines));
  if (const std::size_t lost = names - mesh.named_points.size(); lost > 0)
    notes->push_back(fmt::format("{} named points are no corners of quads and were left out", lost));
}

/// `sides` of the quads as they are oriented.
void find_walls(Section& section, std::span<const HalfEdge> sides) {
  const Mesh& mesh = section.mesh;
  const auto add = [&](const HalfEdge& side, int curve, bool on_boundary) {
    section.walls.push_back({side.forward ? side.lo : side.hi, side.forward ? side.hi : side.lo, side.element,
                             curve, on_boundary});
  };
  std::vector<std::pair<int, int>> with_line;
  for (std::size_t l = 0; l < mesh.lines.size(); ++l) {
    const auto [a, b] = mesh.lines[l];
    const auto at = sides_of_edge(sides, a, b);
    if (at.size() > 1 && mesh.curves[mesh.line_curve[l]].names.empty()) continue;
    add(at[0], mesh.line_curve[l], at.size() == 1);
    with_line.emplace_back(std::min(a, b), std::max(a, b));
  }
  std::sort(with_line.begin(), with_line.end());
  for_each_edge(sides, [&](std::span<const HalfEdge> at) {
    if (at.size() == 1 &&
        !std::binary_search(with_line.begin(), with_line.end(), std::pair(at[0].lo, at[0].hi)))
      add(at[0], -1, true);
  });
}

}  // namespace

Section make_section(const Mesh& given, ReadNotes* notes) {
  require_quads(given);
  Section section;
  section.mesh = given;
  if (notes != nullptr && (!given.periodic.empty() || !given.periodic_faces.empty()))
    notes->push_back("which nodes are images of others is not kept");
  section.mesh.periodic.clear();
  section.mesh.periodic_faces.clear();
  const std::vector<HalfEdge> sides = sorted_half_edges(section.mesh);
  orient(section, sides);
  drop_strange(section.mesh, sides, notes);
  find_walls(section, sorted_half_edges(section.mesh));
  return section;
}

}  // namespace delquad
