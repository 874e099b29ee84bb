#include "features/layers/boundary_graph.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

namespace delquad {

BoundaryGraph::BoundaryGraph(const PlanarDomain& domain)
    : is_image_(domain.patches.size(), 0),
      stops_(domain.boundary.points.size(), 0),
      on_crack_(domain.boundary.points.size(), 0) {
  for (const PatchImage& image : domain.images) is_image_[image.patch] = 1;
  for (const int v : domain.on_crack) on_crack_[v] = 1;
  for (std::size_t p = 0; p < domain.patches.size(); ++p) {
    const PatchBoundary& patch = domain.patches[p];
    for (std::size_t e = 0; e < patch.edges.size(); ++e) {
      const auto& [a, b] = patch.edges[e];
      edges_[{patch.point_node[a], patch.point_node[b]}] = {static_cast<int>(p), static_cast<int>(e)};
    }
  }
  find_stops(domain);
  share_stops(domain);
}

std::optional<std::array<int, 2>> BoundaryGraph::edge_from(int a, int b) const {
  const auto found = edges_.find({a, b});
  return found == edges_.end() ? std::nullopt : std::optional(found->second);
}

bool BoundaryGraph::is_on_axis(int a, int b) const {
  const auto one = edge_from(a, b), other = edge_from(b, a);
  return one && other && is_image((*one)[0]) != is_image((*other)[0]);
}

void BoundaryGraph::find_stops(const PlanarDomain& domain) {
  std::set<std::pair<int, int>> edges;
  for (const auto& [edge, where] : edges_) edges.insert(std::minmax(edge.first, edge.second));
  for (const auto& [a, b] : domain.boundary.lines) edges.insert(std::minmax(a, b));
  std::vector<int> degree(stops_.size(), 0);
  for (const auto& [a, b] : edges) ++degree[a], ++degree[b];
  for (std::size_t v = 0; v < stops_.size(); ++v) stops_[v] = degree[v] != 2 || on_crack_[v];
  for (const NamedPoint& named : domain.boundary.named_points) stops_[named.point] = 1;
  for (const PatchBoundary& patch : domain.patches) {
    std::vector<std::size_t> edge_to(patch.points.size());
    for (std::size_t e = 0; e < patch.edges.size(); ++e) edge_to[patch.edges[e][1]] = e;
    for (std::size_t e = 0; e < patch.edges.size(); ++e) {
      const auto& [p, next] = patch.edges[e];
      const std::size_t last = edge_to[p];
      const double angle =
          inner_angle(patch.points[patch.edges[last][0]], patch.points[p], patch.points[next]);
      if (patch.edge_curve[e] != patch.edge_curve[last] || std::abs(angle - std::numbers::pi) > kLayerCorner)
        stops_[patch.point_node[p]] = 1;
    }
  }
}

/// Corners may be images of images.
void BoundaryGraph::share_stops(const PlanarDomain& domain) {
  const auto share = [&](int a, int b) { stops_[a] = stops_[b] = stops_[a] | stops_[b]; };
  for (int round = 0; round < 2; ++round) {
    for (const PeriodicNodes& pair : domain.boundary.periodic)
      for (const auto& [node, master] : pair.nodes) share(node, master);
    for (const PatchImage& image : domain.images) {
      const PatchBoundary &own = domain.patches[image.patch], &of = domain.patches[image.master];
      for (std::size_t i = 0; i < image.point.size(); ++i)
        share(own.point_node[image.point[i]], of.point_node[i]);
    }
  }
}

double inner_angle(Vec2 before, Vec2 at, Vec2 after) {
  const Vec2 in = at - before, out = after - at;
  return std::numbers::pi - std::atan2(cross(in, out), dot(in, out));
}

}  // namespace delquad
