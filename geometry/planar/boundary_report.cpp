// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/planar/check_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "base/text.h"

namespace delquad {
namespace {

std::string entity_name(const Entity& entity, const std::string& kind) {
  if (entity.names.empty()) return fmt::format("{} {}", kind, entity.tag);
  return "'" + entity.names.front() + "'";
}

std::string loop_name(const std::vector<int>& loop, const PatchBoundary& patch, const Mesh& boundary) {
  std::vector<std::string> names;
  for (const int e : loop) {
    const int curve = patch.edge_curve[e];
    const std::string name = curve < 0 ? "edges without lines" : entity_name(boundary.curves[curve], "curve");
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  const Vec2 at = patch.points[patch.edges[loop.front()][0]];
  return fmt::format("the loop of {} through {} has {} edges", fmt::join(names, ", "), show_point(at),
                     loop.size());
}

}  // namespace

std::vector<std::vector<int>> loops_of_edges(const PatchBoundary& boundary) {
  std::vector<int> edge_from(boundary.points.size(), -1);
  for (std::size_t e = 0; e < boundary.edges.size(); ++e)
    edge_from[boundary.edges[e][0]] = static_cast<int>(e);
  std::vector<char> seen(boundary.points.size(), 0);
  std::vector<std::vector<int>> loops;
  for (std::size_t first = 0; first < seen.size(); ++first) {
    if (seen[first]) continue;
    loops.emplace_back();
    for (int v = static_cast<int>(first); !std::exchange(seen[v], 1); v = boundary.edges[edge_from[v]][1])
      loops.back().push_back(edge_from[v]);
  }
  return loops;
}

std::vector<std::string> odd_boundaries(const PlanarDomain& domain) {
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < domain.patches.size(); ++i) {
    const PatchBoundary& patch = domain.patches[i];
    if (patch.edges.size() % 2 == 0) continue;
    std::vector<std::string> odd;
    for (const auto& loop : loops_of_edges(patch))
      if (loop.size() % 2 == 1) odd.push_back(loop_name(loop, patch, domain.boundary));
    lines.push_back(fmt::format(
        "region {}: an odd number of boundary edges ({}) leaves one triangle at least; {} [odd-boundary]",
        entity_name(domain.boundary.regions[domain.patch_region[i]], "region"), patch.edges.size(),
        fmt::join(odd, "; ")));
  }
  return lines;
}

Mesh edges_of_patches(const PlanarDomain& domain) {
  Mesh edges;
  edges.points = domain.boundary.points;
  edges.curves = {{1, {}}};
  for (const PatchBoundary& patch : domain.patches)
    for (const auto& [i, j] : patch.edges) edges.lines.push_back({patch.point_node[i], patch.point_node[j]});
  edges.line_curve.assign(edges.lines.size(), 0);
  return edges;
}

}  // namespace delquad
