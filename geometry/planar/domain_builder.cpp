#include "geometry/planar/domain_builder.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "delquad/error.h"

namespace delquad {

namespace {

using RegionNames = std::vector<std::optional<std::string>>;

RegionNames region_names(const std::vector<BoundaryLoop>& loops, std::size_t node_count,
                         const std::vector<std::pair<int, std::string>>& loop_regions,
                         const std::string& source) {
  const std::string prefix = source.empty() ? "" : source + ": ";
  const std::vector<int> loop_of = loop_of_nodes(loops, node_count);
  RegionNames names(loops.size());
  for (const auto& [node, name] : loop_regions) {
    const auto v = static_cast<std::size_t>(node);
    if (v >= node_count || loop_of[v] < 0)
      throw InputError(fmt::format("{}region '{}' is inside the loop of node {}, which lies on no loop",
                                   prefix, name, node));
    std::optional<std::string>& mine = names[static_cast<std::size_t>(loop_of[v])];
    if (mine && *mine != name)
      throw InputError(fmt::format("{}one loop has two regions inside: '{}' and '{}'", prefix, *mine, name));
    mine = name;
  }
  return names;
}

// One region a patch; those without a name share "domain".
std::vector<Entity> make_regions(const std::vector<BoundaryLoop>& loops, const std::vector<bool>& filled,
                                 const RegionNames& names) {
  std::vector<Entity> regions;
  std::vector<std::size_t> unnamed;
  for (std::size_t l = 0; l < loops.size(); ++l) {
    if (!filled[l]) continue;
    Entity region{static_cast<int>(regions.size()) + 1, {}};
    if (names[l] && !names[l]->empty())
      region.names.push_back(*names[l]);
    else
      unnamed.push_back(regions.size());
    regions.push_back(std::move(region));
  }
  for (std::size_t i = 0; i < unnamed.size(); ++i)
    regions[unnamed[i]].names.push_back(unnamed.size() == 1 ? "domain" : fmt::format("domain_{}", i + 1));
  return regions;
}

// Drops the points without lines and flattens the rounding of z; indices in loops are brought along.
void compact(Mesh& mesh, std::vector<BoundaryLoop>& loops) {
  const std::vector<int> loop_of = loop_of_nodes(loops, mesh.points.size());
  std::vector<int> renamed(mesh.points.size(), -1);
  std::vector<Vec3> points;
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    if (loop_of[v] < 0) continue;
    renamed[v] = static_cast<int>(points.size());
    const Vec3& p = mesh.points[v];
    points.push_back({p.x, p.y, points.empty() ? p.z : points.front().z});
  }
  mesh.points = std::move(points);
  for (BoundaryLoop& loop : loops)
    for (int& v : loop.nodes) v = renamed[static_cast<std::size_t>(v)];
}

// Turns the lines of a loop so that its region is on the left.
void orient(Mesh& mesh, const BoundaryLoop& loop, bool counterclockwise) {
  for (std::size_t k = 0; k < loop.nodes.size(); ++k) {
    const int a = loop.nodes[k], b = loop.nodes[(k + 1) % loop.nodes.size()];
    mesh.lines[static_cast<std::size_t>(loop.lines[k])] =
        counterclockwise ? std::array{a, b} : std::array{b, a};
  }
}

void append(PatchBoundary& patch, const Mesh& mesh, const BoundaryLoop& loop, bool counterclockwise) {
  const std::size_t n = loop.nodes.size();
  const int base = static_cast<int>(patch.points.size());
  for (std::size_t i = 0; i < n; ++i) {
    const int v = loop.nodes[counterclockwise ? i : (n - i) % n];
    const int line = loop.lines[counterclockwise ? i : n - 1 - i];
    const Vec3& p = mesh.points[static_cast<std::size_t>(v)];
    patch.points.push_back({p.x, p.y});
    patch.point_node.push_back(v);
    patch.edges.push_back({base + static_cast<int>(i), base + static_cast<int>((i + 1) % n)});
    patch.edge_curve.push_back(mesh.line_curve[static_cast<std::size_t>(line)]);
  }
}

}  // namespace

PlanarDomain build_domain(Mesh lines, const std::vector<std::pair<int, std::string>>& loop_regions,
                          const BoundaryNames& names) {
  std::vector<BoundaryLoop> loops = find_loops(lines, names);
  const RegionNames named = region_names(loops, lines.points.size(), loop_regions, names.source);
  std::vector<bool> is_named(loops.size());
  for (std::size_t l = 0; l < loops.size(); ++l) is_named[l] = named[l].has_value();
  const std::vector<bool> filled = filled_loops(loops, is_named);

  PlanarDomain domain;
  Mesh& mesh = domain.boundary;
  mesh.points = std::move(lines.points);
  mesh.lines = std::move(lines.lines);
  mesh.line_curve = std::move(lines.line_curve);
  mesh.curves = std::move(lines.curves);
  mesh.regions = make_regions(loops, filled, named);
  compact(mesh, loops);

  std::vector<int> patch_of(loops.size(), -1);
  for (std::size_t l = 0; l < loops.size(); ++l) {
    orient(mesh, loops[l], filled[l]);
    if (filled[l]) {
      patch_of[l] = static_cast<int>(domain.patches.size());
      domain.patch_region.push_back(patch_of[l]);
      append(domain.patches.emplace_back(), mesh, loops[l], true);
    }
    // A parent's outer loop is there already: it comes first.
    const int parent = loops[l].parent;
    const int around = parent < 0 ? -1 : patch_of[static_cast<std::size_t>(parent)];
    if (around >= 0) append(domain.patches[static_cast<std::size_t>(around)], mesh, loops[l], false);
  }
  return domain;
}

PlanarDomain make_domain(Mesh lines, const DomainOptions& options) {
  const BoundaryNames names = names_of_curves(lines, options.source);
  return build_domain(std::move(lines), options.loop_regions, names);
}

}  // namespace delquad
