// SPDX-License-Identifier: GPL-3.0-or-later
#include "algorithms/finish/separate_duplicates.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <compare>
#include <functional>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>

#include "base/marks.h"
#include "geometry/mesh/tri_topology.h"
#include "smoothing/relocation/element_quality.h"
#include "smoothing/relocation/quad_relocation.h"

namespace delquad {
namespace {

/// Edge of a patch between two points of its boundary.
struct PartEdge {
  std::array<int, 2> nodes;  ///< ascending
  bool is_chord;             ///< whether it lies inside
  int patch;
  std::array<int, 2> ends;  ///< points of the patch at its ends
  friend auto operator<=>(const PartEdge&, const PartEdge&) = default;
};

template <std::size_t N>
void add_sides(const std::vector<std::array<int, N>>& elements, int n_boundary,
               std::vector<std::array<int, 2>>& sides) {
  for (const auto& element : elements)
    for (std::size_t k = 0; k < N; ++k) {
      const int a = element[k], b = element[(k + 1) % N];
      if (a < n_boundary && b < n_boundary) sides.push_back({std::min(a, b), std::max(a, b)});
    }
}

/// A patch with its nodes or the nodes of its image.
struct PatchNodes {
  int patch;
  std::vector<int> node;  ///< node of each boundary point
};

/// Returns the patches in use, then their images. Image nodes of curves inside faces do not exist and are
/// negative.
std::vector<PatchNodes> patches_and_images(const AllPatches& in) {
  std::vector<PatchNodes> all;
  for (std::size_t p = 0; p < in.patches.size(); ++p)
    if (!in.left_out[p]) all.push_back({static_cast<int>(p), in.prepared.patches[p].boundary.point_node});
  const std::size_t n_patches = all.size();
  for (const PeriodicFaces& pair : in.prepared.boundary.periodic_faces) {
    std::map<int, int> image;
    for (const auto& [node, of] : pair.nodes) image[of] = node;
    for (std::size_t i = 0; i < n_patches; ++i) {
      if (in.prepared.patches[all[i].patch].region != pair.master) continue;
      PatchNodes copy = all[i];
      for (int& v : copy.node) {
        const auto at = image.find(v);
        v = at != image.end() ? at->second : -1 - v;
      }
      all.push_back(std::move(copy));
    }
  }
  return all;
}

void add_edges(const AllPatches& in, const PatchNodes& nodes, std::vector<PartEdge>& edges) {
  const auto& [p, node] = nodes;
  const PatchMesh& patch = in.patches[p];
  const int n_boundary = static_cast<int>(node.size());
  std::vector<std::array<int, 2>> sides, rim;
  for (const auto& [a, b] : in.prepared.patches[p].boundary.edges)
    rim.push_back({std::min(a, b), std::max(a, b)});
  std::ranges::sort(rim);
  add_sides(patch.triangles.triangles, n_boundary, sides);
  add_sides(patch.quads.quads, n_boundary, sides);
  add_sides(patch.quads.triangles, n_boundary, sides);
  std::ranges::sort(sides);
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const bool is_twice = i + 1 < sides.size() && sides[i + 1] == sides[i];
    const bool is_chord = is_twice && !std::ranges::binary_search(rim, sides[i]);  // a slit may be one edge
    const auto [a, b] = sides[i];
    edges.push_back({{std::min(node[a], node[b]), std::max(node[a], node[b])}, is_chord, p, {a, b}});
    i += is_twice;
  }
}

/// Returns the ends of the chords to remove, by patch.
std::map<int, std::vector<std::array<int, 2>>> duplicate_chords(const AllPatches& in) {
  std::vector<PartEdge> edges;
  for (const PatchNodes& patch : patches_and_images(in)) add_edges(in, patch, edges);
  std::ranges::sort(edges);
  std::map<int, std::vector<std::array<int, 2>>> chords;
  for (std::size_t i = 1; i < edges.size(); ++i)
    if (edges[i].is_chord && edges[i - 1].nodes == edges[i].nodes)
      if (auto& of = chords[edges[i].patch]; std::ranges::find(of, edges[i].ends) == of.end())
        of.push_back(edges[i].ends);
  return chords;
}

void split_chord(TriPatch& mesh, std::array<int, 2> ends) {
  const auto [a, b] = ends;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k)
      if (mesh.triangles[t][(k + 1) % 3] == a && mesh.triangles[t][(k + 2) % 3] == b)
        return split_side(mesh, static_cast<int>(t), k, 0.5 * (mesh.points[a] + mesh.points[b]));
}

/// A corner is opened only if all quads keep this eta, or this part of its sine.
constexpr double kOpenCornerEta = 0.1, kOpenCornerPart = 0.3;

/// Relocates the vertices from slot `first` on. Returns the quality of the quads around them.
ElementQuality relaxed_quality(QuadTopology& mesh, QuadRelocation& relocation, int first) {
  constexpr int kSweeps = 8;
  const int end = mesh.vertex_slots();
  relocation.adopt_new_vertices(first);
  for (int sweep = 0; sweep < kSweeps; ++sweep)
    for (int v = first; v < end; ++v) relocation.step(v);
  std::vector<int> fresh(end - first);
  std::iota(fresh.begin(), fresh.end(), first);
  ElementQuality total;
  Marks met;
  met.begin(mesh.element_slots());
  for_each_element_around(mesh, fresh, met, [&](int e) { total.add(element_quality(mesh, relocation, e)); });
  return total;
}

bool is_better(const ElementQuality& a, const ElementQuality& b) {
  return a.failing == b.failing ? a.least_sine > b.least_sine : a.failing < b.failing;
}

ElementQuality quality_if_opened(QuadTopology& mesh, QuadRelocation& relocation, int h,
                                 bool counterclockwise) {
  const int first = mesh.vertex_slots();
  mesh.open(h, counterclockwise);
  return relaxed_quality(mesh, relocation, first);
}

ElementQuality quality_with_ring(QuadTopology& mesh, QuadRelocation& relocation, int quad) {
  const int first = mesh.vertex_slots();
  mesh.pillow(std::array<int, 1>{quad});
  return relaxed_quality(mesh, relocation, first);
}

/// A node with one quad in each of two faces, which share two sides, as a point of both patches. At the end
/// of a cut with one quad, both points are the same.
struct DuplicateCorner {
  std::array<int, 2> patch, point;
};

std::vector<DuplicateCorner> duplicate_corners(const AllPatches& in) {
  struct Corner {
    int node;
    std::array<int, 2> beside;  ///< nodes at the other ends of its two sides, ascending
    int patch, point;
    auto operator<=>(const Corner&) const = default;
  };
  std::vector<Corner> corners;
  std::vector<DuplicateCorner> twins;
  for (const auto& [p, node] : patches_and_images(in)) {
    if (in.patches[p].form != PatchForm::kQuads) continue;
    const auto is_inside = [&](int v) { return v >= static_cast<int>(node.size()); };
    for (const auto& quad : in.patches[p].quads.quads)
      for (int k = 0; k < 4; ++k) {
        const int before = quad[(k + 3) % 4], v = quad[k], after = quad[(k + 1) % 4];
        if (is_inside(before) || is_inside(v) || is_inside(after)) continue;
        if (node[before] == node[after]) twins.push_back({{p, p}, {v, v}});
        const auto [low, high] = std::minmax(node[before], node[after]);
        corners.push_back({node[v], {low, high}, p, v});
      }
  }
  std::ranges::sort(corners);
  for (std::size_t i = 1; i < corners.size(); ++i) {
    const Corner &a = corners[i - 1], &b = corners[i];
    if (a.node == b.node && a.beside == b.beside) twins.push_back({{a.patch, b.patch}, {a.point, b.point}});
  }
  return twins;
}

/// Returns the angle at the corner in the plane of the k-th face, radians.
double angle_at(const AllPatches& in, const DuplicateCorner& corner, int k) {
  const QuadPatch& mesh = in.patches[corner.patch[k]].quads;
  const int v = corner.point[k];
  for (const auto& quad : mesh.quads) {
    const auto i = std::ranges::find(quad, v) - quad.begin();
    if (i == 4) continue;
    const Vec2 out = mesh.points[quad[(i + 1) % 4]] - mesh.points[v];
    const Vec2 in_ = mesh.points[quad[(i + 3) % 4]] - mesh.points[v];
    const double angle = std::atan2(cross(out, in_), dot(out, in_));
    return angle < 0 ? angle + 2 * std::numbers::pi : angle;
  }
  return 0;
}

/// A patch whose boundary vertex got a second quad, and the quality around it.
struct Opened {
  QuadPatch mesh;
  ElementQuality quality;
};

/// Opens a side that does not touch the vertex, or adds a ring inside its quad. Returns nothing if that
/// leaves bad quads.
std::optional<Opened> open_corner(const QuadPatch& patch, int v, const ParametricSize& size) {
  QuadTopology mesh(patch);
  QuadRelocation relocation(mesh, size);
  relocation.keep_convex_corners();
  const int quad = QuadTopology::element(mesh.out(v)), side = mesh.next(mesh.out(v));
  struct Way {
    bool possible;
    std::function<ElementQuality()> take;
  };
  const int after = mesh.next(side);
  const Way ways[] = {
      {mesh.twin(side) >= 0 && mesh.can_open(side),
       [&] { return quality_if_opened(mesh, relocation, side, false); }},
      {mesh.twin(after) >= 0 && mesh.can_open(after),
       [&] { return quality_if_opened(mesh, relocation, after, true); }},
      {mesh.can_pillow(std::array<int, 1>{quad}), [&] { return quality_with_ring(mesh, relocation, quad); }}};
  const Way* best = nullptr;
  ElementQuality least;
  least.least_sine = std::min(sine_of_eta(kOpenCornerEta), kOpenCornerPart * least_sine(mesh, quad));
  const int n_vertices = mesh.vertex_slots();
  for (const Way& way : ways) {
    if (!way.possible) continue;
    const auto start = mesh.mark();
    const ElementQuality quality = way.take();
    mesh.rollback(start);
    if (best == nullptr ? quality.least_sine > least.least_sine : is_better(quality, least))
      least = quality, best = &way;
  }
  if (best == nullptr) return {};
  best->take();
  mesh.commit();
  for (int w = n_vertices; w < mesh.vertex_slots(); ++w) relocation.activate(w);
  relocation.relax(0.01, 30);
  return Opened{mesh.to_patch(), least};
}

/// Opens these chords. Returns how many.
int open_chords(QuadPatch& patch, const std::vector<std::array<int, 2>>& chords, const ParametricSize& size) {
  int opened = 0;
  QuadTopology mesh(patch);
  QuadRelocation relocation(mesh, size);
  relocation.keep_convex_corners();
  for (const auto [a, b] : chords) {
    int chord = -1;
    mesh.for_each_out(a, [&](int h) {
      if (mesh.target(h) == b) chord = h;
    });
    if (chord < 0 || !mesh.can_open(chord)) continue;
    ElementQuality quality[2];
    for (const bool counterclockwise : {false, true}) {
      const auto start = mesh.mark();
      quality[counterclockwise] = quality_if_opened(mesh, relocation, chord, counterclockwise);
      mesh.rollback(start);
    }
    quality_if_opened(mesh, relocation, chord, is_better(quality[1], quality[0]));
    mesh.commit();
    ++opened;
    for (const int v : {mesh.vertex_slots() - 2, mesh.vertex_slots() - 1}) relocation.activate(v);
  }
  relocation.relax(0.01, 30);
  patch = mesh.to_patch();
  return opened;
}

/// Returns the patches of one quad whose nodes an earlier patch of one quad also has.
std::vector<int> duplicate_quads(const AllPatches& in) {
  std::vector<std::pair<std::array<int, 4>, int>> quads;
  for (const auto& [p, node] : patches_and_images(in)) {
    const QuadPatch& mesh = in.patches[p].quads;
    if (mesh.quads.size() != 1 || !mesh.triangles.empty()) continue;
    std::array<int, 4> nodes = mesh.quads[0];
    for (int& v : nodes) v = node[v];
    std::ranges::sort(nodes);
    quads.emplace_back(nodes, p);
  }
  std::ranges::sort(quads);
  std::vector<int> twins;
  for (std::size_t i = 1; i < quads.size(); ++i)
    if (quads[i].first == quads[i - 1].first && std::ranges::count(twins, quads[i].second) == 0)
      twins.push_back(quads[i].second);
  return twins;
}

void put_ring_inside(QuadPatch& patch, const ParametricSize& size) {
  QuadTopology mesh(patch);
  QuadRelocation relocation(mesh, size);
  const int first = mesh.vertex_slots();
  mesh.pillow(std::array<int, 1>{0});
  relocation.adopt_new_vertices(first);
  relocation.activate_all();
  relocation.relax(0.01, 30);
  patch = mesh.to_patch();
}

}  // namespace

SeparationSummary separate_duplicates(const AllPatches& in) {
  SeparationSummary summary;
  for (const auto& [p, chords] : duplicate_chords(in)) {
    PatchMesh& patch = in.patches[p];
    patch.inside.clear();
    const int all = static_cast<int>(chords.size());
    int separated = all;
    if (patch.form == PatchForm::kQuads) {
      separated = open_chords(patch.quads, chords, *in.prepared.patches[p].size);
    } else {
      for (const auto& chord : chords) split_chord(patch.triangles, chord);
    }
    summary.chords += separated;
    summary.left += all - separated;
  }
  for (const int p : duplicate_quads(in)) {
    in.patches[p].inside.clear();
    put_ring_inside(in.patches[p].quads, *in.prepared.patches[p].size);
    ++summary.rings;
  }
  for (const DuplicateCorner& corner : duplicate_corners(in)) {
    const auto is_open = [&](int k) {
      const auto has_it = [&](const auto& quad) {
        return std::ranges::find(quad, corner.point[k]) != quad.end();
      };
      return std::ranges::count_if(in.patches[corner.patch[k]].quads.quads, has_it) > 1;
    };
    if (is_open(0) || is_open(1)) {  // opened by an earlier corner
      ++summary.corners;
      continue;
    }
    std::optional<Opened> opened[2];
    for (const int k : {0, 1})
      opened[k] = open_corner(in.patches[corner.patch[k]].quads, corner.point[k],
                              *in.prepared.patches[corner.patch[k]].size);
    ++(opened[0] || opened[1] ? summary.corners : summary.corners_left);
    // The wider angle leaves more space for two quads.
    int k = angle_at(in, corner, 0) >= angle_at(in, corner, 1) ? 0 : 1;
    if (!opened[k] || (opened[1 - k] && opened[1 - k]->quality.failing < opened[k]->quality.failing))
      k = 1 - k;
    if (!opened[k]) continue;
    in.patches[corner.patch[k]].inside.clear();
    in.patches[corner.patch[k]].quads = std::move(opened[k]->mesh);
  }
  return summary;
}

}  // namespace delquad
