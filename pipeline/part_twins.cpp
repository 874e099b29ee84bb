#include "pipeline/part_twins.h"

#include <algorithm>
#include <array>
#include <compare>
#include <map>

#include "pipeline/prepare.h"
#include "smoothing/quad_relocation.h"

namespace delquad {
namespace {

/// An edge of a patch between two points of its boundary.
struct Edge {
  std::array<int, 2> nodes;  ///< ascending
  bool is_chord;             ///< it lies inside
  int patch;
  std::array<int, 2> ends;  ///< points of the patch
  friend auto operator<=>(const Edge&, const Edge&) = default;
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

void add_edges(const AllPatches& in, int p, std::vector<Edge>& edges) {
  const PatchMesh& patch = in.patches[p];
  const std::vector<int>& node = in.prepared.patches[p].boundary.point_node;
  const int n_boundary = static_cast<int>(node.size());
  std::vector<std::array<int, 2>> sides;
  add_sides(patch.triangles.triangles, n_boundary, sides);
  add_sides(patch.quads.quads, n_boundary, sides);
  add_sides(patch.quads.triangles, n_boundary, sides);
  std::ranges::sort(sides);
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const bool is_chord = i + 1 < sides.size() && sides[i + 1] == sides[i];
    const auto [a, b] = sides[i];
    edges.push_back({{std::min(node[a], node[b]), std::max(node[a], node[b])}, is_chord, p, {a, b}});
    i += is_chord;
  }
}

/// By patch, the ends of the chords that have to go.
std::map<int, std::vector<std::array<int, 2>>> twin_chords(const AllPatches& in) {
  std::vector<Edge> edges;
  for (std::size_t p = 0; p < in.patches.size(); ++p)
    if (!in.left_out[p]) add_edges(in, static_cast<int>(p), edges);
  std::ranges::sort(edges);
  std::map<int, std::vector<std::array<int, 2>>> chords;
  for (std::size_t i = 1; i < edges.size(); ++i)
    if (edges[i].is_chord && edges[i - 1].nodes == edges[i].nodes)
      chords[edges[i].patch].push_back(edges[i].ends);
  return chords;
}

void part_chord(TriPatch& mesh, std::array<int, 2> ends) {
  const auto corner_after = [&](int t, int v) {
    return static_cast<int>(std::ranges::find(mesh.triangles[t], v) - mesh.triangles[t].begin() + 1) % 3;
  };
  const auto has_side = [&](const std::array<int, 3>& t) {
    for (int k = 0; k < 3; ++k)
      if (t[k] == ends[0] && t[(k + 1) % 3] == ends[1]) return true;
    return false;
  };
  const auto [a, b] = ends;
  const int left = static_cast<int>(std::ranges::find_if(mesh.triangles, has_side) - mesh.triangles.begin());
  const int k = (corner_after(left, b)) % 3, right = mesh.neighbours[left][k];
  const int c = mesh.triangles[left][k], l = corner_after(right, a), d = mesh.triangles[right][l];
  const int m = static_cast<int>(mesh.points.size()), n = static_cast<int>(mesh.triangles.size());
  const auto across = [&](int t, int v) {
    return mesh.neighbours[t][std::ranges::find(mesh.triangles[t], v) - mesh.triangles[t].begin()];
  };
  const int bc = across(left, a), ca = across(left, b), ad = across(right, b), db = across(right, a);
  mesh.points.push_back(0.5 * (mesh.points[a] + mesh.points[b]));
  // Around m: (m, c, a), (m, a, d), (m, d, b), (m, b, c).
  const std::array<int, 4> fan{left, right, n, n + 1}, rim{c, a, d, b}, outside{ca, ad, db, bc};
  const std::array<int, 4> before{left, right, right, left};
  mesh.triangles.resize(n + 2);
  mesh.neighbours.resize(n + 2);
  for (int i = 0; i < 4; ++i) {
    const int next = (i + 1) % 4, last = (i + 3) % 4;
    mesh.triangles[fan[i]] = {m, rim[i], rim[next]};
    mesh.neighbours[fan[i]] = {outside[i], fan[next], fan[last]};
    if (outside[i] >= 0 && before[i] != fan[i])
      std::ranges::replace(mesh.neighbours[outside[i]], before[i], fan[i]);
  }
}

/// The worst of the four quads of an opening once the two new vertices have settled.
double worst_once_open(QuadTopology& mesh, QuadRelocation& relocation, int h, bool counterclockwise) {
  constexpr int kSweeps = 8;
  const int first = mesh.vertex_slots();
  mesh.open(h, counterclockwise);
  relocation.adopt_new_vertices(first);
  for (int sweep = 0; sweep < kSweeps; ++sweep)
    for (const int v : {first, first + 1}) relocation.step(v);
  double worst = 1;
  for (const int v : {first, first + 1})
    mesh.for_each_out(v, [&](int g) { worst = std::min(worst, least_sine(mesh, QuadTopology::element(g))); });
  return worst;
}

/// Returns how many were opened.
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
    double worst[2];
    for (const bool counterclockwise : {false, true}) {
      const auto start = mesh.mark();
      worst[counterclockwise] = worst_once_open(mesh, relocation, chord, counterclockwise);
      mesh.rollback(start);
    }
    worst_once_open(mesh, relocation, chord, worst[1] > worst[0]);
    mesh.commit();
    ++opened;
    for (const int v : {mesh.vertex_slots() - 2, mesh.vertex_slots() - 1}) relocation.activate(v);
  }
  relocation.relax(0.01, 30);
  patch = mesh.to_patch();
  return opened;
}

/// The patches that are one quad each on nodes on which a patch before is one quad.
std::vector<int> twin_quads(const AllPatches& in) {
  std::vector<std::pair<std::array<int, 4>, int>> quads;
  for (std::size_t p = 0; p < in.patches.size(); ++p) {
    const QuadPatch& mesh = in.patches[p].quads;
    if (in.left_out[p] || mesh.quads.size() != 1 || !mesh.triangles.empty()) continue;
    std::array<int, 4> nodes = mesh.quads[0];
    for (int& v : nodes) v = in.prepared.patches[p].boundary.point_node[v];
    std::ranges::sort(nodes);
    quads.emplace_back(nodes, static_cast<int>(p));
  }
  std::ranges::sort(quads);
  std::vector<int> twins;
  for (std::size_t i = 1; i < quads.size(); ++i)
    if (quads[i].first == quads[i - 1].first) twins.push_back(quads[i].second);
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

PartingSummary part_twins(const AllPatches& in) {
  PartingSummary summary;
  for (const auto& [p, chords] : twin_chords(in)) {
    PatchMesh& patch = in.patches[p];
    patch.inside.clear();
    const int all = static_cast<int>(chords.size());
    int parted = all;
    if (patch.form == PatchForm::kQuads) {
      parted = open_chords(patch.quads, chords, *in.prepared.patches[p].size);
    } else {
      for (const auto& chord : chords) part_chord(patch.triangles, chord);
    }
    summary.chords += parted;
    summary.left += all - parted;
  }
  for (const int p : twin_quads(in)) {
    in.patches[p].inside.clear();
    put_ring_inside(in.patches[p].quads, *in.prepared.patches[p].size);
    ++summary.rings;
  }
  return summary;
}

}  // namespace delquad
