#include "geometry/planar/check_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "base/text.h"
#include "delquad/error.h"

namespace delquad {
namespace {

/// The edges of a patch, loop by loop.
std::vector<std::vector<int>> loops_of(const PatchBoundary& patch) {
  std::vector<int> edge_from(patch.points.size(), -1);
  for (std::size_t e = 0; e < patch.edges.size(); ++e) edge_from[patch.edges[e][0]] = static_cast<int>(e);
  std::vector<bool> seen(patch.edges.size());
  std::vector<std::vector<int>> loops;
  for (std::size_t first = 0; first < patch.edges.size(); ++first) {
    if (seen[first]) continue;
    loops.emplace_back();
    for (int e = static_cast<int>(first); !seen[e]; e = edge_from[patch.edges[e][1]]) {
      seen[e] = true;
      loops.back().push_back(e);
    }
  }
  return loops;
}

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

std::vector<std::string> odd_boundaries(const PlanarDomain& domain) {
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < domain.patches.size(); ++i) {
    const PatchBoundary& patch = domain.patches[i];
    if (patch.edges.size() % 2 == 0) continue;
    std::vector<std::string> odd;
    for (const auto& loop : loops_of(patch))
      if (loop.size() % 2 == 1) odd.push_back(loop_name(loop, patch, domain.boundary));
    lines.push_back(
        fmt::format("region {}: an odd number of boundary edges ({}) leaves one triangle at least; {}",
                    entity_name(domain.boundary.regions[domain.patch_region[i]], "region"),
                    patch.edges.size(), fmt::join(odd, "; ")));
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
