#include "patches/boundary_cap.h"

#include <utility>

namespace delquad {

std::vector<BoundaryLoop> take_loops(const PatchBoundary& boundary) {
  std::vector<BoundaryLoop> loops;
  std::vector<int> next(boundary.points.size()), edge(boundary.points.size());
  for (size_t e = 0; e < boundary.edges.size(); ++e)
    next[boundary.edges[e][0]] = boundary.edges[e][1], edge[boundary.edges[e][0]] = static_cast<int>(e);
  std::vector<char> seen(boundary.points.size(), 0);
  for (size_t first = 0; first < seen.size(); ++first) {
    if (seen[first]) continue;
    loops.emplace_back();
    for (int v = static_cast<int>(first); !std::exchange(seen[v], 1); v = next[v])
      loops.back().push_back({boundary.points[v], boundary.point_node[v], boundary.edge_curve[edge[v]]});
  }
  return loops;
}

PatchBoundary make_boundary(const std::vector<BoundaryLoop>& loops) {
  PatchBoundary boundary;
  for (const BoundaryLoop& loop : loops) {
    const int first = static_cast<int>(boundary.points.size()), n = static_cast<int>(loop.size());
    for (int i = 0; i < n; ++i) {
      boundary.points.push_back(loop[i].point);
      boundary.point_node.push_back(loop[i].node);
      boundary.edge_curve.push_back(loop[i].curve);
      boundary.edges.push_back({first + i, first + (i + 1) % n});
    }
  }
  return boundary;
}

void cut_off_tip(BoundaryLoop& loop, std::size_t tip, std::size_t k, std::span<const LoopPoint> fresh) {
  BoundaryLoop rest;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const std::size_t from_tip = (i + loop.size() - tip) % loop.size();
    if (from_tip == 0)
      rest.insert(rest.end(), fresh.begin(), fresh.end());
    else if (from_tip >= k && loop.size() - from_tip >= k)
      rest.push_back(loop[i]);
  }
  loop = std::move(rest);
}

}  // namespace delquad
