#include "geometry/mesh/open_quads.h"

namespace delquad {

OpenQuads::OpenQuads(const Mesh& mesh, std::span<const HalfEdge> sides)
    : twin_(4 * mesh.quads.size(), -1), node_(twin_.size(), -1), patch_(mesh.quads.size(), -1) {
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
    const int from = side.forward ? side.lo : side.hi, to = side.forward ? side.hi : side.lo;
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
  std::vector<int> waiting;
  for (std::size_t q = 0; q < patch_.size(); ++q) {
    if (patch_[q] >= 0) continue;
    patch_[q] = n_patches_;
    waiting.push_back(static_cast<int>(q));
    while (!waiting.empty()) {
      const int at = waiting.back();
      waiting.pop_back();
      for (int h = 4 * at; h < 4 * at + 4; ++h)
        if (const int t = twin_[h]; t >= 0 && patch_[quad(t)] < 0) {
          patch_[quad(t)] = n_patches_;
          waiting.push_back(quad(t));
        }
    }
    ++n_patches_;
  }
}

}  // namespace delquad
