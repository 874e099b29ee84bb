// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/planar/domain_builder.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "base/disjoint_sets.h"
#include "base/segment.h"
#include "base/sort_unique.h"
#include "delquad/error.h"
#include "geometry/mesh/double_nodes.h"
#include "geometry/mesh/drop_unused_points.h"
#include "geometry/mesh/keep_elements.h"

namespace delquad {

namespace {

/// Builds a domain. A side of a line has the same index as the corner of its face at which it begins.
class DomainBuilder {
 public:
  DomainBuilder(Mesh lines, const Arrangement& arrangement, FaceRegions regions, const BoundaryNames& names,
                const SpecialCurves& special)
      : arrangement_(arrangement), regions_(std::move(regions)), names_(names) {
    domain_.boundary = std::move(lines);
    domain_.boundary.regions = std::move(regions_.regions);
    if (!special.may_bound_nothing) check_lines();
    drop_points_without_lines();
    orient_lines();
    for (int s = 0; s < n_sides(); ++s) node_.push_back(start(s));
  }

  void open_cracks(const std::vector<char>& cracks) {
    const std::vector<int> next = next_sides();
    join_corners(next, cracks);
    double_nodes(cracks);
    for (int l = 0, n = static_cast<int>(lines_.size()); l < n; ++l) redraw(l, next, cracks);
  }

  PlanarDomain domain() {
    std::vector<int> n_lines(mesh().points.size(), 0);
    for (const auto& line : mesh().lines)
      for (const int v : line) ++n_lines[v];
    domain_.has_junctions = std::ranges::any_of(n_lines, [](int n) { return n != 2; });
    for (std::size_t f = 0; f < arrangement_.faces.size(); ++f) {
      if (regions_.region[f] < 0) continue;
      domain_.patch_region.push_back(regions_.region[f]);
      add_patch(arrangement_.faces[f]);
    }
    return std::move(domain_);
  }

 private:
  int n_sides() const { return static_cast<int>(arrangement_.face_of.size()); }
  const Mesh& mesh() const { return domain_.boundary; }
  int start(int side) const { return start_of(lines_, side); }
  Vec2 at(int v) const { return {mesh().points[v].x, mesh().points[v].y}; }
  int region_at(int side) const {
    const int face = arrangement_.face_of[side];
    return face < 0 ? -1 : regions_.region[face];
  }

  void check_lines() const {
    for (std::size_t l = 0; l < mesh().lines.size(); ++l) {
      const int side = 2 * static_cast<int>(l);
      if (region_at(side) >= 0 || region_at(side + 1) >= 0) continue;
      const Vec3 &a = mesh().points[mesh().lines[l][0]], &b = mesh().points[mesh().lines[l][1]];
      throw InputError(
          fmt::format("{}{} lies outside of every region from ({:.10g}, {:.10g}) to ({:.10g}, {:.10g}) "
                      "[embedded-outside]",
                      names_.prefix(), names_.curve(mesh().line_curve[l]), a.x, a.y, b.x, b.y));
    }
  }

  /// Drops points without lines, and sets one z for all others.
  void drop_points_without_lines() {
    drop_unused_points(domain_.boundary);
    for (Vec3& p : domain_.boundary.points) p.z = mesh().points.front().z;
  }

  /// Orients lines so that the region is on the left; of two, the inner one. Sides keep their numbers.
  void orient_lines() {
    lines_ = mesh().lines;
    for (int l = 0; l < static_cast<int>(lines_.size()); ++l)
      if (belongs_left(2 * l + 1)) std::swap(domain_.boundary.lines[l][0], domain_.boundary.lines[l][1]);
  }
  bool belongs_left(int side) const {
    if (region_at(side) < 0) return false;
    if (region_at(side ^ 1) < 0) return true;
    return arrangement_.faces[arrangement_.face_of[side]].around == arrangement_.face_of[side ^ 1];
  }

  std::vector<int> next_sides() const {
    std::vector<int> next(n_sides());
    const auto add = [&](const Arrangement::Cycle& cycle) {
      for (std::size_t i = 0; i < cycle.size(); ++i) next[cycle[i]] = cycle[(i + 1) % cycle.size()];
    };
    for (const auto& face : arrangement_.faces) std::ranges::for_each(face.cycles, add);
    std::ranges::for_each(arrangement_.outside, add);
    return next;
  }
  bool is_crack(int line, const std::vector<char>& cracks) const { return cracks[mesh().line_curve[line]]; }

  /// Joins corners of regions that meet along a line, unless it is a crack.
  void join_corners(const std::vector<int>& next, const std::vector<char>& cracks) {
    joined_ = DisjointSets(n_sides());
    for (int s = 0; s < n_sides(); ++s)
      if (!is_crack(s / 2, cracks) && region_at(s) >= 0 && region_at(s ^ 1) >= 0)
        joined_.join(next[s], s ^ 1);
  }

  void double_nodes(const std::vector<char>& cracks) {
    std::vector<char> on_crack(mesh().points.size(), 0), opens(n_sides(), 0);
    for (std::size_t l = 0; l < lines_.size(); ++l)
      if (is_crack(static_cast<int>(l), cracks))
        for (const int v : lines_[l]) on_crack[v] = 1;
    for (int s = 0; s < n_sides(); ++s) opens[s] = on_crack[start(s)] && region_at(s) >= 0;
    delquad::double_nodes(joined_, opens, node_, domain_.boundary.points);
    for (int s = 0; s < n_sides(); ++s)
      if (opens[s]) domain_.on_crack.push_back(node_[s]);
    sort_unique(domain_.on_crack);
  }

  /// Gives line l the nodes of its corners; cracks get lines on both lips.
  void redraw(int l, const std::vector<int>& next, const std::vector<char>& cracks) {
    Mesh& mesh = domain_.boundary;
    const auto ends = [&](int side) { return std::array{node_[side], node_[next[side]]}; };
    const bool turned = mesh.lines[l][0] != lines_[l][0];
    const int side = 2 * l + (region_at(2 * l) < 0 || turned);
    mesh.lines[l] = ends(side);
    if (side % 2 == 1 && !turned) std::swap(mesh.lines[l][0], mesh.lines[l][1]);
    const auto other = ends(side ^ 1);
    if (!is_crack(l, cracks) || region_at(side ^ 1) < 0 ||
        other == std::array{mesh.lines[l][1], mesh.lines[l][0]})
      return;
    other_lip_.resize(lines_.size(), -1);
    other_lip_[l] = side ^ 1;
    add_lip_line(mesh, mesh.line_curve[l], other, lip_curves_);
  }

  void add_patch(const Arrangement::Face& face) {
    PatchBoundary& patch = domain_.patches.emplace_back();
    std::vector<int> visited;
    for (const auto& cycle : face.cycles)
      for (const int side : cycle) visited.push_back(start(side));
    std::ranges::sort(visited);
    for (const auto& cycle : face.cycles) {
      const int n = static_cast<int>(cycle.size()), base = static_cast<int>(patch.points.size());
      for (int i = 0; i < n; ++i) {
        const int side = cycle[i];
        const bool meets_itself = std::ranges::equal_range(visited, start(side)).size() > 1;
        patch.points.push_back(meets_itself ? opened(cycle[(i + n - 1) % n], side) : at(start(side)));
        patch.point_node.push_back(node_[side]);
        patch.edges.push_back({base + i, base + (i + 1) % n});
        patch.edge_curve.push_back(curve_of(side));
      }
    }
  }

  /// Returns the place of the corner between two sides, moved inside along its bisector.
  Vec2 opened(int before, int after) const {
    const int v = start(after);
    return at(v) + into_corner(at(start(before)), at(v), at(start(after ^ 1)), kOpening);
  }

  int curve_of(int side) const {
    const int curve = mesh().line_curve[side / 2];
    return !other_lip_.empty() && other_lip_[side / 2] == side ? lip_curves_.at(curve) : curve;
  }

  const Arrangement& arrangement_;
  FaceRegions regions_;
  const BoundaryNames& names_;
  PlanarDomain domain_;
  std::vector<std::array<int, 2>> lines_;  ///< lines as in the arrangement
  std::vector<int> node_;                  ///< node of each corner
  DisjointSets joined_;                    ///< corners that have the same node
  std::vector<int> other_lip_;             ///< side of each line that has an own line; -1: none
  std::map<int, int> lip_curves_;          ///< for each crack, the curve of its second lip
};

/// Removes a curve and its lines; its edges stay in the patches.
void drop_curve(PlanarDomain& domain, int curve) {
  Mesh& mesh = domain.boundary;
  const auto rename = [&](int& c) { c = c == curve ? -1 : c - (c > curve); };
  keep_lines(mesh, [&](std::size_t l) {
    rename(mesh.line_curve[l]);
    return mesh.line_curve[l] >= 0;
  });
  mesh.curves.erase(mesh.curves.begin() + curve);
  for (PatchBoundary& patch : domain.patches) std::ranges::for_each(patch.edge_curve, rename);
}

}  // namespace

PlanarDomain build_domain(Mesh lines, const Arrangement& arrangement, FaceRegions regions,
                          const BoundaryNames& names, const SpecialCurves& special) {
  DomainBuilder builder(std::move(lines), arrangement, std::move(regions), names, special);
  if (!special.cracks.empty()) builder.open_cracks(special.cracks);
  PlanarDomain domain = builder.domain();
  if (special.dangling >= 0) drop_curve(domain, special.dangling);
  return domain;
}

void drop_stray_lines(PlanarDomain& domain) {
  std::set<std::pair<int, int>> of_patches;
  std::vector<char> used(domain.boundary.points.size(), 0);
  for (const PatchBoundary& patch : domain.patches)
    for (const auto& edge : patch.edges) {
      const int a = patch.point_node[edge[0]], b = patch.point_node[edge[1]];
      of_patches.insert(std::minmax(a, b));
      used[a] = used[b] = 1;
    }
  Mesh& mesh = domain.boundary;
  keep_lines(mesh, [&](std::size_t l) {
    return of_patches.contains(std::minmax(mesh.lines[l][0], mesh.lines[l][1]));
  });
  keep_nodes(domain, used);
}

void keep_nodes(PlanarDomain& domain, const std::vector<char>& used) {
  Mesh& mesh = domain.boundary;
  std::vector<int> renamed(used.size(), -1);
  int n = 0;
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (!used[v]) continue;
    mesh.points[n] = mesh.points[v];
    if (!domain.places.empty()) domain.places[n] = domain.places[v];
    renamed[v] = n++;
  }
  mesh.points.resize(n);
  if (!domain.places.empty()) domain.places.resize(n);
  const auto rename = [&](auto& nodes) {
    for (int& v : nodes) v = renamed[v];
  };
  std::ranges::for_each(mesh.lines, rename);
  std::ranges::for_each(mesh.quads, rename);
  for (auto* patches : {&domain.patches, &domain.outlines})
    for (PatchBoundary& patch : *patches) rename(patch.point_node);
  rename(domain.on_crack);
  for (DomainPiece& piece : domain.pieces) {
    rename(piece.ends);
    rename(piece.nodes);
  }
  renumber_nodes(mesh, renamed);
}

PlanarDomain make_domain(Mesh lines, const std::string& source) {
  const BoundaryNames names = names_of_curves(lines, source);
  const Arrangement arrangement = arrange_lines(lines, names);
  FaceRegions regions = regions_by_nesting(arrangement, FaceNames(arrangement.faces.size()));
  return build_domain(std::move(lines), arrangement, std::move(regions), names);
}

}  // namespace delquad
