// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/given/named_domain.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <span>
#include <utility>

#include "base/predicates.h"
#include "features/embedded/dangling_edges.h"
#include "geometry/mesh/half_edges.h"
#include "geometry/mesh/keep_elements.h"
#include "geometry/planar/domain_builder.h"

namespace delquad {
namespace {

constexpr int kNoRegion = -1, kSeveralRegions = -2;

Vec2 flat(const Vec3& p) { return {p.x, p.y}; }

/// For each face of the lines the region of the elements along it: kNoRegion without elements,
/// kSeveralRegions when they differ.
class RegionsInside {
 public:
  RegionsInside(const Mesh& mesh, const Mesh& lines, const Arrangement& arrangement)
      : mesh_(mesh), lines_(lines), arrangement_(arrangement), region_(arrangement.faces.size(), kNoRegion) {
    for (std::size_t l = 0; l < lines.lines.size(); ++l)
      line_at_[std::minmax(lines.lines[l][0], lines.lines[l][1])] = static_cast<int>(l);
    add(mesh.triangles, mesh.triangle_region);
    add(mesh.quads, mesh.quad_region);
  }
  int operator[](std::size_t face) const { return region_[face]; }

 private:
  template <std::size_t N>
  void add(const std::vector<std::array<int, N>>& elements, const std::vector<int>& region) {
    for (std::size_t e = 0; e < elements.size(); ++e)
      for (std::size_t k = 0; k < N; ++k) {
        const auto at = line_at_.find(std::minmax(elements[e][k], elements[e][(k + 1) % N]));
        if (at == line_at_.end()) continue;
        const int face = arrangement_.face_of[2 * at->second + !is_left(elements[e], at->second)];
        if (face < 0) continue;
        int& inside = region_[face];
        inside = inside == kNoRegion || inside == region[e] ? region[e] : kSeveralRegions;
      }
  }

  /// Whether the element lies to the left of a line.
  template <std::size_t N>
  bool is_left(const std::array<int, N>& element, int line) const {
    Vec2 centre{0, 0};
    for (const int v : element) centre += (1.0 / N) * flat(mesh_.points[v]);
    const auto [a, b] = lines_.lines[line];
    return orient2d(flat(mesh_.points[a]), flat(mesh_.points[b]), centre) > 0;
  }

  const Mesh& mesh_;
  const Mesh& lines_;
  const Arrangement& arrangement_;
  std::map<std::pair<int, int>, int> line_at_;
  std::vector<int> region_;
};

/// For each face the tags of the curves that bound it.
std::vector<std::vector<int>> bounding_curves(const Mesh& lines, const Arrangement& arrangement) {
  std::vector<std::set<int>> tags(arrangement.faces.size());
  for (int side = 0; side < static_cast<int>(arrangement.face_of.size()); ++side)
    if (const int face = arrangement.face_of[side]; face >= 0 && !arrangement.has_one_face(side / 2))
      tags[face].insert(lines.curves[lines.line_curve[side / 2]].tag);
  std::vector<std::vector<int>> sorted;
  for (const std::set<int>& set : tags) sorted.emplace_back(set.begin(), set.end());
  return sorted;
}

/// The groups of the surface at each face; none where the file knows of no surface there.
FaceNames groups_of_faces(const Mesh& mesh, const Mesh& lines, const Arrangement& arrangement,
                          const DeclaredSurfaces& surfaces) {
  FaceNames groups(arrangement.faces.size());
  const RegionsInside regions(mesh, lines, arrangement);
  const auto bounding = bounding_curves(lines, arrangement);
  for (std::size_t f = 0; f < groups.size(); ++f) {
    const int region = regions[f];
    if (region != kNoRegion) {
      groups[f] = region == kSeveralRegions ? std::vector<std::string>{} : mesh.regions[region].names;
      continue;
    }
    const auto bounds = [&](const DeclaredSurfaces::Surface& s) { return s.curves == bounding[f]; };
    const auto& all = surfaces.surfaces;
    const auto surface = std::find_if(all.begin(), all.end(), bounds);
    if (surface != all.end() && std::find_if(surface + 1, all.end(), bounds) == all.end())
      groups[f] = surface->entity.names;
  }
  return groups;
}

using Interfaces = std::map<std::pair<int, int>, std::vector<std::array<int, 2>>>;

/// Edges between two regions, by these.
Interfaces edges_between_regions(const Mesh& mesh) {
  Interfaces interfaces;
  for_each_edge(sorted_half_edges(mesh), [&](std::span<const HalfEdge> sides) {
    if (sides.size() != 2) return;
    const std::pair<int, int> regions =
        std::minmax(region_of(mesh, sides[0].element), region_of(mesh, sides[1].element));
    if (regions.first != regions.second) interfaces[regions].push_back({sides[0].lo, sides[0].hi});
  });
  return interfaces;
}

/// The lines of the mesh, and the lines that it lacks where they part its regions. Writers leave them out for
/// programs that take none inside a mesh.
Mesh lines_of(const Mesh& mesh, const std::string& source) {
  Mesh lines;
  lines.points = mesh.points;
  lines.lines = mesh.lines;
  lines.line_curve = mesh.line_curve;
  lines.curves = mesh.curves;
  lines.named_points = mesh.named_points;
  std::set<std::pair<int, int>> known;
  for (const auto& [a, b] : mesh.lines) known.insert(std::minmax(a, b));
  int last_tag = 0;
  for (const Entity& curve : mesh.curves) last_tag = std::max(last_tag, curve.tag);
  Interfaces interfaces = edges_between_regions(mesh);
  for (auto& [regions, edges] : interfaces) {
    std::erase_if(edges, [&](const auto& edge) { return known.contains({edge[0], edge[1]}); });
    if (edges.empty()) continue;
    lines.lines.insert(lines.lines.end(), edges.begin(), edges.end());
    lines.line_curve.resize(lines.lines.size(), static_cast<int>(lines.curves.size()));
    lines.curves.push_back({++last_tag, {}});
  }
  if (lines.lines.size() == mesh.lines.size()) return lines;
  const Arrangement arrangement = arrange_lines(lines, names_of_curves(lines, source));
  keep_lines(lines, [&](std::size_t l) {
    return l < mesh.lines.size() || !arrangement.has_one_face(static_cast<int>(l));
  });
  return lines;
}

/// Nodes with a name and without lines.
std::vector<int> single_points(const Mesh& lines) {
  std::vector<char> has_line(lines.points.size(), 0);
  for (const auto& line : lines.lines)
    for (const int v : line) has_line[v] = 1;
  std::vector<int> single;
  for (const NamedPoint& named : lines.named_points)
    if (!has_line[named.point]) single.push_back(named.point);
  return single;
}

/// Returns the curve of the edges at single points.
int add_dangling_edges(Mesh& lines, const std::vector<int>& points, const SizeField& size,
                       const std::string& source) {
  const auto ends = dangling_ends(lines, points, size, [&](std::size_t) { return source + ": the point"; });
  const int curve = static_cast<int>(lines.curves.size());
  lines.curves.push_back({});
  for (std::size_t i = 0; i < points.size(); ++i)
    for (const Vec3& end : ends[i]) {
      lines.lines.push_back({points[i], static_cast<int>(lines.points.size())});
      lines.line_curve.push_back(curve);
      lines.points.push_back(end);
    }
  return curve;
}

}  // namespace

bool has_single_points(const Mesh& mesh) { return !single_points(mesh).empty(); }

PlanarDomain make_named_domain(const Mesh& mesh, const DeclaredSurfaces& surfaces, const std::string& source,
                               const SizeField* size) {
  Mesh lines = lines_of(mesh, source);
  const std::vector<int> single = size != nullptr ? single_points(lines) : std::vector<int>{};
  const int dangling = single.empty() ? -1 : add_dangling_edges(lines, single, *size, source);
  const BoundaryNames names = names_of_curves(lines, source);
  const Arrangement arrangement = arrange_lines(lines, names);
  const FaceNames groups = groups_of_faces(mesh, lines, arrangement, surfaces);
  FaceRegions regions = regions_by_nesting(arrangement, groups);
  const bool lines_only = mesh.triangles.empty() && mesh.quads.empty();
  const bool is_named =
      std::ranges::any_of(groups, [](const auto& group) { return group && !group->empty(); });
  if (lines_only && !is_named && regions.regions.size() == 1 && surfaces.group_names.size() == 1)
    regions.regions[0].names = surfaces.group_names;
  return build_domain(std::move(lines), arrangement, std::move(regions), names, {{}, dangling});
}

}  // namespace delquad
