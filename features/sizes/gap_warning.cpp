#include "features/sizes/gap_warning.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "base/box_tree.h"
#include "base/predicates.h"
#include "base/segment.h"
#include "base/text.h"
#include "geometry/mesh/entity_names.h"

namespace delquad {
namespace {

/// Gaps are told of below this part of an edge.
constexpr double kNarrow = 0.01;

/// An edge with a patch on its left only.
struct OuterEdge {
  Vec2 a, b;
  std::array<int, 2> nodes;
  int curve;
};

std::vector<OuterEdge> outer_edges(const PlanarDomain& domain) {
  std::map<std::pair<int, int>, int> sides;
  const auto key = [](const PatchBoundary& patch, const std::array<int, 2>& edge) {
    return std::minmax(patch.point_node[edge[0]], patch.point_node[edge[1]]);
  };
  for (const PatchBoundary& patch : domain.patches)
    for (const auto& edge : patch.edges) ++sides[key(patch, edge)];
  std::vector<OuterEdge> edges;
  for (const PatchBoundary& patch : domain.patches)
    for (std::size_t e = 0; e < patch.edges.size(); ++e) {
      const auto [i, j] = patch.edges[e];
      if (patch.edge_curve[e] < 0 || sides[key(patch, {i, j})] != 1) continue;
      edges.push_back({patch.points[i],
                       patch.points[j],
                       {patch.point_node[i], patch.point_node[j]},
                       patch.edge_curve[e]});
    }
  return edges;
}

}  // namespace

void warn_of_gaps(const PlanarDomain& domain, std::vector<Warning>& warnings) {
  const std::vector<OuterEdge> edges = outer_edges(domain);
  std::vector<Box<Vec2>> boxes;
  for (const OuterEdge& edge : edges) boxes.push_back({lower(edge.a, edge.b), upper(edge.a, edge.b)});
  const BoxTree<Vec2> tree(boxes);
  std::set<int> on_crack(domain.on_crack.begin(), domain.on_crack.end());
  std::set<int> near;  // nodes at gaps
  double least = 0, shown = 0;
  std::pair<int, int> curves;
  Vec2 place;
  for (const OuterEdge& from : edges) {
    const int node = from.nodes[0];
    if (on_crack.contains(node)) continue;
    const double reach = kNarrow * norm(from.b - from.a);
    tree.search(
        reach * reach, [&](const auto& branch) { return branch.box.distance2(from.a); },
        [&](int i) {
          const OuterEdge& edge = edges[i];
          if (edge.nodes[0] == node || edge.nodes[1] == node || edge.nodes[0] == from.nodes[1] ||
              orient2d(edge.a, edge.b, from.a) >= 0)
            return;
          const double gap = norm(nearest_on_segment(from.a, edge.a, edge.b) - from.a);
          if (!(gap > 0) || gap > std::min(reach, kNarrow * norm(edge.b - edge.a))) return;
          near.insert(node);
          // Of gaps that are equal, that between curves side by side says most.
          const double aside = std::abs(cross(from.b - from.a, edge.b - edge.a));
          const double blame = gap * (1 + aside / (norm(from.b - from.a) * norm(edge.b - edge.a)));
          if (least > 0 && blame >= least) return;
          least = blame;
          shown = gap;
          curves = {from.curve, edge.curve};
          place = from.a;
        });
  }
  if (near.empty()) return;
  const auto title = [&](int c) { return curve_title(domain.boundary.curves[c]); };
  warnings.emplace_back(
      fmt::format("{} and {} leave a gap of {:.2g} between them at {}, far narrower than the "
                  "edges there{}: "
                  "where regions should join, their curves must lie on each other",
                  title(curves.first), title(curves.second), shown, show_point(place),
                  near.size() > 1 ? fmt::format(", and so at {} nodes", near.size()) : ""));
}

}  // namespace delquad
