// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/mesh/open_quads.h"

#include <algorithm>

#include "base/disjoint_sets.h"

namespace delquad {

OpenQuads::OpenQuads(const Mesh& mesh, std::span<const HalfEdge> sides)
    : twin_(4 * mesh.quads.size(), -1), node_(twin_.size(), -1) {
  join(mesh, sides);
  find_nodes();
  find_patches();
}

void OpenQuads::join(const Mesh& mesh, std::span<const HalfEdge> sides) {
  const int n_triangles = static_cast<int>(mesh.triangles.size());
  const auto region = [&](int quad) {
    return static_cast<std::size_t>(quad) < mesh.quad_region.size() ? mesh.quad_region[quad] : 0;
  };
  const auto half_edge = [&](const HalfEdge& side) {
    const auto& v = mesh.quads[side.element - n_triangles];
    const auto [from, to] = side.run();
    int k = 0;
    while (v[k] != from || v[(k + 1) % 4] != to) ++k;
    return 4 * (side.element - n_triangles) + k;
  };
  for_each_edge(sides, [&](std::span<const HalfEdge> edge) {
    if (edge.size() != 2 || edge[0].element < n_triangles || edge[0].forward == edge[1].forward) return;
    const int h = half_edge(edge[0]), t = half_edge(edge[1]);
    if (region(quad(h)) != region(quad(t))) return;
    twin_[h] = t;
    twin_[t] = h;
  });
}

void OpenQuads::find_nodes() {
  for (int h = 0; h < static_cast<int>(node_.size()); ++h) {
    if (node_[h] >= 0) continue;
    int first = h;
    while (twin_[first] >= 0 && next(twin_[first]) != h) first = next(twin_[first]);
    if (twin_[first] >= 0) first = h;
    const int node = size();
    out_.push_back(first);
    quads_at_.push_back(0);
    for_each_out(node, [&](int g) {
      node_[g] = node;
      ++quads_at_[node];
    });
  }
}

void OpenQuads::find_patches() {
  DisjointSets patches(twin_.size() / 4);
  for (int h = 0; h < static_cast<int>(twin_.size()); ++h)
    if (twin_[h] >= 0) patches.join(quad(h), quad(twin_[h]));
  patch_ = patches.places();
  for (const int p : patch_) n_patches_ = std::max(n_patches_, p + 1);
}

}  // namespace delquad
