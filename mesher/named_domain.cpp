#include "mesher/named_domain.h"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <utility>

#include "base/predicates.h"
#include "geometry/planar/boundary_loops.h"
#include "mesh/half_edges.h"

namespace delquad {
namespace {

constexpr int kNone = -1, kSeveral = -2;

Vec2 flat(const Vec3& p) { return {p.x, p.y}; }

/// The loop and the side of it that an edge of an element belongs to.
struct LoopEdge {
  int loop;
  int from;  ///< node where the edge starts, seen counterclockwise
};
using LoopEdges = std::map<std::pair<int, int>, LoopEdge>;

LoopEdges edges_of(const std::vector<BoundaryLoop>& loops) {
  LoopEdges edges;
  for (std::size_t l = 0; l < loops.size(); ++l) {
    const std::vector<int>& nodes = loops[l].nodes;
    for (std::size_t k = 0; k < nodes.size(); ++k)
      edges[std::minmax(nodes[k], nodes[(k + 1) % nodes.size()])] = {static_cast<int>(l), nodes[k]};
  }
  return edges;
}

/// For each loop the region of the elements just inside: kNone without elements, kSeveral when they differ.
class RegionsInside {
 public:
  RegionsInside(const Mesh& mesh, const std::vector<BoundaryLoop>& loops)
      : mesh_(mesh), edges_(edges_of(loops)), region_(loops.size(), kNone) {
    add(mesh.triangles, mesh.triangle_region);
    add(mesh.quads, mesh.quad_region);
  }
  int operator[](std::size_t loop) const { return region_[loop]; }

 private:
  template <std::size_t N>
  void add(const std::vector<std::array<int, N>>& elements, const std::vector<int>& region) {
    for (std::size_t e = 0; e < elements.size(); ++e)
      for (std::size_t k = 0; k < N; ++k) {
        const auto at = edges_.find(std::minmax(elements[e][k], elements[e][(k + 1) % N]));
        if (at == edges_.end() || !is_left(elements[e], at->first, at->second.from)) continue;
        int& inside = region_[static_cast<std::size_t>(at->second.loop)];
        inside = inside == kNone || inside == region[e] ? region[e] : kSeveral;
      }
  }

  /// Whether the element lies to the left of its edge, run from node `from`.
  template <std::size_t N>
  bool is_left(const std::array<int, N>& element, std::pair<int, int> edge, int from) const {
    Vec2 centre{0, 0};
    for (const int v : element) centre += (1.0 / N) * flat(mesh_.points[v]);
    const int to = edge.first == from ? edge.second : edge.first;
    return orient2d(flat(mesh_.points[from]), flat(mesh_.points[to]), centre) > 0;
  }

  const Mesh& mesh_;
  LoopEdges edges_;
  std::vector<int> region_;
};

/// For each loop the tags of its curves and of those of the loops directly inside: what bounds a region
/// there.
std::vector<std::vector<int>> bounding_curves(const Mesh& lines, const std::vector<BoundaryLoop>& loops) {
  std::vector<std::set<int>> tags(loops.size());
  for (std::size_t l = 0; l < loops.size(); ++l)
    for (const int line : loops[l].lines) {
      const int tag = lines.curves[lines.line_curve[line]].tag;
      tags[l].insert(tag);
      if (loops[l].parent >= 0) tags[loops[l].parent].insert(tag);
    }
  std::vector<std::vector<int>> sorted;
  for (const std::set<int>& set : tags) sorted.emplace_back(set.begin(), set.end());
  return sorted;
}

/// The groups of the surface inside each loop; none where the file knows of no surface there.
using LoopGroups = std::vector<std::optional<std::vector<std::string>>>;

/// `lines`: those of which the loops are.
LoopGroups groups_inside(const Mesh& mesh, const Mesh& lines, const std::vector<BoundaryLoop>& loops,
                         const DeclaredSurfaces& surfaces) {
  LoopGroups groups(loops.size());
  const RegionsInside regions(mesh, loops);
  const auto bounding = bounding_curves(lines, loops);
  for (std::size_t l = 0; l < loops.size(); ++l) {
    const int region = regions[l];
    if (region != kNone) {
      groups[l] = region == kSeveral ? std::vector<std::string>{} : mesh.regions[region].names;
      continue;
    }
    const auto bounds = [&](const DeclaredSurfaces::Surface& s) { return s.curves == bounding[l]; };
    const auto& all = surfaces.surfaces;
    const auto surface = std::find_if(all.begin(), all.end(), bounds);
    if (surface != all.end() && std::find_if(surface + 1, all.end(), bounds) == all.end())
      groups[l] = surface->entity.names;
  }
  return groups;
}

using Interfaces = std::map<std::pair<int, int>, std::vector<std::array<int, 2>>>;

/// Edges between two regions, by these.
Interfaces edges_between_regions(const Mesh& mesh) {
  const auto region_of = [&](const HalfEdge& side) {
    const int n = static_cast<int>(mesh.triangles.size());
    return side.element < n ? mesh.triangle_region[side.element] : mesh.quad_region[side.element - n];
  };
  Interfaces interfaces;
  for_each_edge(sorted_half_edges(mesh), [&](std::span<const HalfEdge> sides) {
    if (sides.size() != 2) return;
    const std::pair<int, int> regions = std::minmax(region_of(sides[0]), region_of(sides[1]));
    if (regions.first != regions.second) interfaces[regions].push_back({sides[0].lo, sides[0].hi});
  });
  return interfaces;
}

/// The lines of the mesh, and loops between its regions that it has no lines of: writers leave those out for
/// programs that take none inside a mesh.
Mesh lines_of(const Mesh& mesh) {
  Mesh lines;
  lines.points = mesh.points;
  lines.lines = mesh.lines;
  lines.line_curve = mesh.line_curve;
  lines.curves = mesh.curves;
  std::vector<int> uses(mesh.points.size(), 0);
  for (const auto& line : mesh.lines)
    for (const int v : line) ++uses[v];
  int last_tag = 0;
  for (const Entity& curve : mesh.curves) last_tag = std::max(last_tag, curve.tag);
  for (const auto& [regions, edges] : edges_between_regions(mesh)) {
    std::vector<int> all_uses = uses;
    for (const auto& edge : edges)
      for (const int v : edge) ++all_uses[v];
    const bool closed = std::ranges::all_of(
        edges, [&](const auto& edge) { return all_uses[edge[0]] == 2 && all_uses[edge[1]] == 2; });
    if (!closed) continue;
    uses = std::move(all_uses);
    lines.lines.insert(lines.lines.end(), edges.begin(), edges.end());
    lines.line_curve.resize(lines.lines.size(), static_cast<int>(lines.curves.size()));
    lines.curves.push_back({++last_tag, {}});
  }
  return lines;
}

}  // namespace

PlanarDomain make_named_domain(const Mesh& mesh, const DeclaredSurfaces& surfaces,
                               const std::string& source) {
  const Mesh lines = lines_of(mesh);
  const std::vector<BoundaryLoop> loops = find_loops(lines, names_of_curves(lines, source));
  const LoopGroups groups = groups_inside(mesh, lines, loops, surfaces);
  DomainOptions options{source, {}};
  std::map<std::pair<double, double>, std::vector<std::string>> names;  // by a loop's first node
  for (std::size_t l = 0; l < loops.size(); ++l) {
    if (!groups[l]) continue;
    const int first = loops[l].nodes[0];
    options.loop_regions.emplace_back(first, groups[l]->empty() ? "" : groups[l]->front());
    if (!groups[l]->empty()) names[{mesh.points[first].x, mesh.points[first].y}] = *groups[l];
  }
  PlanarDomain domain = make_domain(lines, options);
  for (std::size_t i = 0; i < domain.patches.size(); ++i) {
    const Vec2 first = domain.patches[i].points[0];
    const auto found = names.find({first.x, first.y});
    if (found != names.end()) domain.boundary.regions[domain.patch_region[i]].names = found->second;
  }
  const bool lines_only = mesh.triangles.empty() && mesh.quads.empty();
  if (lines_only && names.empty() && domain.patches.size() == 1 && surfaces.group_names.size() == 1)
    domain.boundary.regions[0].names = surfaces.group_names;
  return domain;
}

}  // namespace delquad
