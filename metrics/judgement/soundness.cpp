// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrics/judgement/soundness.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "base/disjoint_sets.h"
#include "base/parallel.h"
#include "base/sort_unique.h"
#include "base/text.h"
#include "geometry/mesh/check_invariants.h"
#include "geometry/mesh/keep_elements.h"
#include "metrics/shape.h"

namespace delquad {
namespace {

using Edge = std::array<int, 2>;

/// Adds a reason, unless there are no places.
void add_reason(const Mesh& mesh, const Places& places, const std::string& one, const std::string& several,
                Soundness& result) {
  if (places.count == 0) return;
  result.places.insert(result.places.end(), places.first.begin(), places.first.end());
  result.reasons.push_back(describe(mesh, places, one, several));
}

/// Returns the middle of an element, with its face if any.
template <std::size_t N>
Place middle(const Mesh& mesh, const std::array<int, N>& v, const std::vector<int>& regions,
             std::size_t element) {
  Vec3 sum;
  for (const int i : v) sum = sum + mesh.points[i];
  return {(1.0 / N) * sum, element < regions.size() ? regions[element] : -1};
}

enum class QuadFlaw : char { kNone, kInverted, kFolded };

/// Returns the edges of a mesh that are lines, sorted.
std::vector<Edge> line_edges(const Mesh& mesh) {
  std::vector<Edge> edges;
  for (const auto& [a, b] : mesh.lines) edges.push_back({std::min(a, b), std::max(a, b)});
  std::ranges::sort(edges);
  return edges;
}

/// Returns whether the model forces a quad to be as narrow. Then a corner between two curves is below the
/// limit for elements, and the quad is no worse.
bool is_as_narrow_as_model(const std::array<int, 4>& v, const ElementShape<4>& shape,
                           const std::vector<Edge>& lines) {
  constexpr double kNearly = 0.9;
  const auto is_line = [&](int a, int b) {
    return std::ranges::binary_search(lines, Edge{std::min(a, b), std::max(a, b)});
  };
  for (int k = 0; k < 4; ++k)
    if (std::sin(shape.angle[k]) <= kLeastJacobian && shape.angle[k] < 1 &&
        shape.scaled_jacobian >= kNearly * std::sin(shape.angle[k]) && shape.scaled_jacobian > 0 &&
        is_line(v[(k + 3) % 4], v[k]) && is_line(v[k], v[(k + 1) % 4]))
      return true;
  return false;
}

QuadFlaw flaw_of(const Mesh& mesh, int q, const ElementSides& sides, const std::vector<Edge>& lines) {
  const auto corners = corners_of(mesh, mesh.quads[q]);
  const Vec3 side = sides.of_quad(q);
  const ElementShape<4> shape = element_shape(corners, side);
  if (!is_readable(corners, side, shape) && !is_as_narrow_as_model(mesh.quads[q], shape, lines))
    return QuadFlaw::kInverted;
  return quad_warp(corners) > kFold ? QuadFlaw::kFolded : QuadFlaw::kNone;
}

void check_shapes(const Mesh& mesh, const ElementSides& sides, Soundness& result) {
  std::vector<QuadFlaw> flaws(mesh.quads.size());
  const std::vector<Edge> lines = line_edges(mesh);
  parallel_ranges(flaws.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t q = begin; q < end; ++q) flaws[q] = flaw_of(mesh, static_cast<int>(q), sides, lines);
  });
  Places inverted, folded, triangles;
  for (std::size_t q = 0; q < flaws.size(); ++q)
    if (flaws[q] != QuadFlaw::kNone)
      (flaws[q] == QuadFlaw::kInverted ? inverted : folded)
          .add(middle(mesh, mesh.quads[q], mesh.quad_region, q));
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (const auto corners = corners_of(mesh, mesh.triangles[t]);
        !is_readable(corners, sides.of_triangle(static_cast<int>(t)),
                     triangle_shape(mesh, static_cast<int>(t), sides)))
      triangles.add(middle(mesh, mesh.triangles[t], mesh.triangle_region, t));
  add_reason(mesh, inverted, "1 quad is inverted or flat", "quads are inverted or flat", result);
  add_reason(mesh, folded, "1 quad is folded by more than 90 degrees",
             "quads are folded by more than 90 degrees", result);
  add_reason(mesh, triangles, "1 triangle is inverted or flat", "triangles are inverted or flat", result);
}

void check_finite(const Mesh& mesh, Soundness& result) {
  std::vector<int> face(mesh.points.size(), -1);
  for (std::size_t q = 0; q < std::min(mesh.quads.size(), mesh.quad_region.size()); ++q)
    for (const int v : mesh.quads[q]) face[v] = mesh.quad_region[q];
  Places places;
  for (std::size_t i = 0; i < mesh.points.size(); ++i)
    if (const Vec3& p = mesh.points[i]; !std::isfinite(p.x + p.y + p.z)) places.add({p, face[i]});
  add_reason(mesh, places, "1 point is not finite", "points are not finite", result);
}

/// Returns the boundary of a patch with its layers and wedges.
const PatchBoundary& outline_of(const MeshingSetup& prepared, std::size_t patch) {
  const std::vector<PatchBoundary>& outlines = prepared.plane.outlines;
  return outlines.empty() ? prepared.patches[patch].boundary : outlines[patch];
}

/// Returns the number of patches at each edge on the boundary of a planar domain.
std::map<Edge, int> patches_at_edges(const MeshingSetup& prepared) {
  std::map<Edge, int> patches;
  for (std::size_t k = 0; k < prepared.patches.size(); ++k) {
    const PatchBoundary& boundary = outline_of(prepared, k);
    for (const auto& [i, j] : boundary.edges) {
      const int a = boundary.point_node[i], b = boundary.point_node[j];
      ++patches[{std::min(a, b), std::max(a, b)}];
    }
  }
  return patches;
}

/// Returns the number of pieces in the outline of a patch: loops, or groups of touching loops.
int pieces_of(const PatchBoundary& boundary) {
  DisjointSets joined(boundary.points.size());
  int pieces = static_cast<int>(joined.size());
  for (const auto& [i, j] : boundary.edges) pieces -= joined.join(i, j);
  return pieces;
}

/// Returns the Euler characteristic of a planar domain, by points and edges on its outlines and by patches,
/// which are discs with holes.
int euler_characteristic(const MeshingSetup& prepared, const std::map<Edge, int>& edges) {
  std::set<int> nodes;
  for (const auto& [edge, patches] : edges) nodes.insert(edge.begin(), edge.end());
  int euler = static_cast<int>(nodes.size()) - static_cast<int>(edges.size());
  for (std::size_t k = 0; k < prepared.patches.size(); ++k) euler += 2 - pieces_of(outline_of(prepared, k));
  return euler;
}

void compare_euler(int mesh, int model, Soundness& result) {
  if (mesh != model)
    result.reasons.push_back(
        fmt::format("its Euler characteristic is {}, but the model has {}", mesh, model));
}

/// Returns the number of wrong edges.
int check_planar(const MeshingSetup& prepared, const Mesh& mesh, std::span<const HalfEdge> sides,
                 Soundness& result) {
  const std::map<Edge, int> wanted = patches_at_edges(prepared);
  Places wrong;
  std::size_t found = 0;
  auto next = wanted.begin();  // both are sorted
  for_each_edge(sides, [&](std::span<const HalfEdge> edge) {
    const Edge ends{edge[0].lo, edge[0].hi};
    while (next != wanted.end() && next->first < ends) ++next;
    const bool is_wanted = next != wanted.end() && next->first == ends;
    found += is_wanted;
    if (static_cast<int>(edge.size()) == (is_wanted ? next->second : 2)) return;
    wrong.add({0.5 * (mesh.points[edge[0].lo] + mesh.points[edge[0].hi]), -1});
  });
  add_reason(mesh, wrong, "1 edge is in more or fewer elements than the domain asks for",
             "edges are in more or fewer elements than the domain asks for", result);
  if (found < wanted.size())
    result.reasons.push_back(
        fmt::format("{} of {} boundary edges are missing", wanted.size() - found, wanted.size()));
  compare_euler(topology_of(mesh, sides).euler_characteristic, euler_characteristic(prepared, wanted),
                result);
  return wrong.count;
}

/// Returns the number of fans of elements minus the number of vertices, since a surface may touch itself in
/// points. `mesh` rarely has such points.
int pinches(const Mesh& mesh) {
  std::vector<std::array<int, 2>> corners;  // vertex and element, sorted
  for_each_element(mesh, [&](int element, const auto& v) {
    for (const int i : v) corners.push_back({i, element});
  });
  sort_unique(corners);
  int vertices = 0;
  for (std::size_t k = 0; k < corners.size(); ++k) vertices += k == 0 || corners[k][0] != corners[k - 1][0];
  DisjointSets fans(corners.size());
  int n_fans = static_cast<int>(corners.size());
  const auto index = [&](int v, int element) {
    return static_cast<int>(std::ranges::lower_bound(corners, std::array{v, element}) - corners.begin());
  };
  for_each_edge(sorted_half_edges(mesh), [&](std::span<const HalfEdge> edge) {
    for (const HalfEdge& side : edge.subspan(1))
      for (const int v : {side.lo, side.hi})
        n_fans -= fans.join(index(v, edge[0].element), index(v, side.element));
  });
  return n_fans - vertices;
}

/// Returns the same number for the faces of a model that the mesh has.
int pinches_of_model(Mesh fine, const Mesh& mesh) {
  std::vector<char> has(fine.regions.size(), 0);
  for (const auto* regions : {&mesh.triangle_region, &mesh.quad_region})
    for (const int region : *regions) has[region] = 1;
  keep_triangles(fine, [&](std::size_t t) { return has[fine.triangle_region[t]] != 0; });
  return pinches(fine);
}

void check_surface(const Mesh& fine, const Mesh& mesh, const SurfaceReport& report, Soundness& result) {
  add_reason(mesh, report.turned_elements, "1 element faces away from the model",
             "elements face away from the model", result);
  add_reason(mesh, report.nonconforming_edges, "1 edge is in more or fewer elements than the model asks for",
             "edges are in more or fewer elements than the model asks for", result);
  // Cones whose tips touch need no node there.
  if (const int euler = report.mesh.euler_characteristic; euler != report.model.euler_characteristic)
    compare_euler(euler + pinches(mesh), report.model.euler_characteristic + pinches_of_model(fine, mesh),
                  result);
  if (report.model.watertight() && !report.mesh.watertight())
    result.reasons.push_back(fmt::format("it has {} open edges, the model none", report.mesh.free_edges));
  const std::string lost = fmt::format("places of the model are lost, up to {:.3g} sizes from the mesh",
                                       report.surface_to_mesh.max_in_sizes);
  add_reason(mesh, report.surface_to_mesh.unexplained, "1 of the " + lost, lost, result);
  for (const Distances* d :
       {&report.mesh_to_surface, &report.nodes_in_faces, &report.nodes_on_curves, &report.nodes_at_corners}) {
    const std::string off =
        fmt::format("places of the mesh are off the model, up to {:.3g} sizes", d->max_in_sizes);
    add_reason(mesh, d->unexplained, "1 of the " + off, off, result);
  }
}

}  // namespace

std::string Soundness::text() const { return fmt::format("{}", fmt::join(reasons, "; ")); }

std::string Soundness::complaint() const {
  std::string text = sound() ? "" : "the mesh is not sound: " + this->text() + " [unsound-mesh]";
  if (!beyond.empty())
    text += fmt::format("{}it is beyond the limits: {} [beyond-limits]", text.empty() ? "" : "; ",
                        fmt::join(beyond, "; "));
  return text;
}

Place middle_of_quad(const Mesh& mesh, int quad) {
  return middle(mesh, mesh.quads[quad], mesh.quad_region, static_cast<std::size_t>(quad));
}

std::string show_place(const Mesh& mesh, const Place& place) {
  const std::string at = show_point(place.at);
  const bool known = place.face >= 0 && static_cast<std::size_t>(place.face) < mesh.regions.size();
  return known ? fmt::format("face {} at {}", mesh.regions[place.face].tag, at) : "at " + at;
}

std::string describe(const Mesh& mesh, const Places& places, const std::string& one,
                     const std::string& several) {
  constexpr std::size_t kMostShown = 3;
  const std::size_t n_shown = std::min(kMostShown, places.first.size());
  std::string text = places.count == 1 ? one : fmt::format("{} {}", places.count, several);
  for (std::size_t i = 0; i < n_shown; ++i)
    text += (i == 0 ? ": " : ", ") + show_place(mesh, places.first[i]);
  if (static_cast<std::size_t>(places.count) > n_shown) text += ", ...";
  return text;
}

Soundness check_elements(const MeshingSetup& prepared, const Mesh& mesh) {
  Soundness result;
  check_finite(mesh, result);
  if (result.sound())
    check_shapes(mesh, prepared.surface ? ElementSides(mesh) : ElementSides(mesh, {0, 0, 1}), result);
  return result;
}

Soundness check_soundness(const MeshingSetup& prepared, const Mesh& mesh, const SurfaceReport* report,
                          std::span<const HalfEdge> sides) {
  std::vector<char> irregular;
  if (prepared.surface) irregular = irregular_curves(prepared.surface->whole().fine);
  const std::vector<std::string> violations = check_invariants(mesh, irregular, sides);
  Soundness result = check_elements(prepared, mesh);
  int wrong_edges = 0;
  if (!prepared.surface) wrong_edges = check_planar(prepared, mesh, sides, result);
  if (report != nullptr) {
    check_surface(prepared.surface->whole().fine, mesh, *report, result);
    wrong_edges = report->nonconforming_edges.count;
  }
  // Most of these concern the same edges.
  if (!violations.empty() && wrong_edges == 0)
    result.reasons.push_back(
        fmt::format("it is not conforming ({} violations): {}", violations.size(), violations[0]));
  return result;
}

}  // namespace delquad
