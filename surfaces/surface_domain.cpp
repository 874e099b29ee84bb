#include "surfaces/surface_domain.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "mesh/activity.h"
#include "mesh/box_tree.h"
#include "mesh/constrained_delaunay.h"
#include "mesh/error.h"
#include "mesh/parallel.h"
#include "mesh/predicates.h"
#include "surfaces/corner_caps.h"
#include "surfaces/curve_nodes.h"
#include "surfaces/face_nodes.h"
#include "surfaces/narrow_places.h"
#include "surfaces/narrow_seeds.h"
#include "surfaces/patch_outline.h"
#include "surfaces/tip_caps.h"
#include "surfaces/tube_sizes.h"

namespace delquad {

namespace {

/// A boundary loop of quads needs four edges to enclose an area.
constexpr int kFewestLoopEdges = 4;
/// A cut to the tip of a cone has a node besides its ends.
constexpr int kFewestTipEdges = 2;
/// So many times curves are refined to keep boundary polygons from crossing.
constexpr int kRefinements = 8;
/// Curves shorter than this part of the size are warned of.
constexpr double kShort = 0.5;

class DomainBuilder {
 public:
  DomainBuilder(const SurfaceModel& model, Flattening flattening, const SizeField& size,
                const MatchingSolver& solver, const SizeField* asked)
      : model_(model),
        fine_(model.fine),
        size_(size),
        asked_(asked != nullptr ? *asked : size),
        solver_(solver),
        maps_(std::move(flattening.patches)),
        cut_face_(fine_.curves.size(), -1),
        chains_(curve_chains(model)) {
    for (const SurfaceCut& cut : flattening.cuts) cut_face_[cut.curve] = cut.face;
    const LineIndex lines(chains_);
    for (const FlatPatch& map : maps_) outlines_.push_back(lines.outline(map, chains_, face_name(map)));
    corners_ = face_corners(fine_, chains_, maps_, outlines_);
    tube_sizes_ = tube_sizes(fine_, chains_, maps_, outlines_, size_);
    across_.emplace(fine_, chains_, maps_, outlines_);
  }

  SurfaceDomain build() {
    measure_curves();
    share_integrals();
    set_minima();
    warn_of_short_curves();
    std::vector<int> odd;
    for (int attempt = 0; place(odd) > 0; ++attempt) {
      if (attempt == kRefinements)
        throw FaceError(
            maps_[crossing_].face,
            fmt::format("{}: its boundary crosses itself in the parameter plane however fine its curves are",
                        face_name(maps_[crossing_])));
    }
    for (const int p : odd)
      warnings_.push_back({"faces with an odd boundary that no curve can make even", 0,
                           face_name(maps_[p]) + " has an odd boundary that no curve can make even"});
    return collect();
  }

 private:
  std::string face_name(const FlatPatch& map) const {
    return fmt::format("face {}", fine_.regions[map.face].tag);
  }

  /// Calls work(patch), in parallel.
  void for_each_patch(const std::function<void(size_t)>& work) const {
    parallel_for(
        maps_.size(),
        [&](size_t p) {
          const DoingFace face(fine_.regions[maps_[p].face].tag);
          work(p);
        },
        [&](size_t p) { return static_cast<double>(maps_[p].flat.points.size()); });
  }

  void measure_curves() {
    const std::vector<std::vector<double>> limits = limits_on_curves();
    int hint = -1;
    const SizeFunction delta = [&](const Vec3& x) { return size_.at(x, hint); };
    const SizeFunction asked = [&](const Vec3& x) { return asked_.at(x, hint); };
    for (const CurveChain& chain : chains_) {
      const auto& limit = limits[integrals_.size()];
      integrals_.push_back(size_integral(fine_, chain, delta, limit));
      const bool same = limit.empty() && &asked_ == &size_;
      lengths_.push_back(same ? integrals_.back().total() : size_integral(fine_, chain, asked).total());
      demands_.push_back({integrals_.back().total(), chain.closed() ? 3 : 1, {}});
    }
    for (size_t p = 0; p < maps_.size(); ++p)
      for (const auto& loop : outlines_[p])
        for (const CurveSide& side : loop)
          if (side.begins(chains_[side.chain])) demands_[side.chain].patches.push_back(static_cast<int>(p));
  }

  /// What tubes allow at each point of each curve; empty for curves that bound none.
  std::vector<std::vector<double>> limits_on_curves() const {
    std::vector<std::vector<double>> limits(chains_.size());
    for (size_t p = 0; p < maps_.size(); ++p) {
      if (tube_sizes_[p].empty()) continue;
      for (const auto& loop : outlines_[p])
        for (const CurveSide& side : loop) {
          auto& of_chain = limits[side.chain];
          of_chain.resize(chains_[side.chain].points.size(), std::numeric_limits<double>::max());
          const auto [first, second] =
              std::pair(side.forward ? side.from : side.to, side.forward ? side.to : side.from);
          of_chain[side.line] = std::min(of_chain[side.line], tube_sizes_[p][first]);
          of_chain[side.line + 1] = std::min(of_chain[side.line + 1], tube_sizes_[p][second]);
        }
    }
    return limits;
  }

  /// The curves of a strip want the mean of what each wants alone.
  void share_integrals() {
    group_ = group_facing_curves(fine_, chains_, *across_, size_);
    std::vector<double> sum(chains_.size(), 0), members(chains_.size(), 0);
    for (size_t c = 0; c < chains_.size(); ++c)
      sum[group_[c]] += std::log(demands_[c].integral), ++members[group_[c]];
    for (size_t c = 0; c < chains_.size(); ++c)
      demands_[c].integral = std::exp(sum[group_[c]] / members[group_[c]]);
  }

  void warn_of_short_curves() {
    for (size_t c = 0; c < chains_.size(); ++c)
      if (const double length = lengths_[c]; length < kShort)
        warnings_.push_back({fmt::format("curves shorter than {:g} times the size", kShort), 1 / length,
                             fmt::format("curve {} is {:.2g} times the size long: it gets {} edge(s)",
                                         fine_.curves[chains_[c].curve].tag, length, demands_[c].minimum)});
  }

  void set_minima() {
    // The quad in a sharp corner has its fourth vertex inside: beyond its edges there must be others.
    std::vector<std::map<int, int>> sharp_ends(chains_.size());  // of each curve, by patch
    for (const FaceCorner& corner : corners_)
      if (corner.is_tip())
        demands_[corner.after].minimum = std::max(demands_[corner.after].minimum, kFewestTipEdges);
      else if (corner.angle < kSharpAngle)
        ++sharp_ends[corner.before][corner.patch], ++sharp_ends[corner.after][corner.patch];
    for (size_t c = 0; c < chains_.size(); ++c)
      for (const auto& [patch, ends] : sharp_ends[c])
        demands_[c].minimum = std::max(demands_[c].minimum, 1 + ends);
    // Of curves between the same two ends, one at most may be a single edge.
    std::map<std::pair<int, int>, size_t> single;
    for (size_t c = 0; c < chains_.size(); ++c) {
      if (chains_[c].closed()) {
        if (demands_[c].patches.size() == 2)
          demands_[c].minimum = std::max(demands_[c].minimum, kFewestLoopEdges);
        continue;
      }
      const auto ends = std::minmax(chains_[c].points.front(), chains_[c].points.back());
      const auto [it, first] = single.try_emplace(ends, c);
      if (first) continue;
      size_t longer = c;
      if (integrals_[it->second].total() > integrals_[c].total()) std::swap(longer, it->second);
      demands_[longer].minimum = std::max(demands_[longer].minimum, 2);
    }
  }

  /// Counts edges, places nodes and boundaries. Demands more edges of the curves that cross; returns of how
  /// many.
  int place(std::vector<int>& odd) {
    const auto counts = even_counts(demands_, static_cast<int>(maps_.size()), solver_, odd);
    nodes_ = place_nodes(model_, chains_, cut_face_, integrals_,
                         face_nodes(fine_, chains_, *across_, integrals_, counts, group_, size_));
    boundaries_.resize(maps_.size());
    std::vector<std::vector<int>> bad(maps_.size());
    for_each_patch([&](size_t p) {
      std::vector<int> chain_of_edge;
      boundaries_[p] = place_boundary(maps_[p], outlines_[p], chains_, nodes_, &chain_of_edge);
      bad[p] = curves_at_fault(boundaries_[p], chain_of_edge, outlines_[p]);
    });
    std::vector<int> refine;
    for (size_t p = 0; p < maps_.size(); ++p) {
      if (!bad[p].empty()) crossing_ = p;
      refine.insert(refine.end(), bad[p].begin(), bad[p].end());
    }
    std::sort(refine.begin(), refine.end());
    refine.erase(std::unique(refine.begin(), refine.end()), refine.end());
    for (const int c : refine) demands_[c].minimum = 2 * counts[c];
    return static_cast<int>(refine.size());
  }

  /// The curves that keep the boundary from enclosing quads; empty if none do.
  static std::vector<int> curves_at_fault(const PatchBoundary& boundary,
                                          const std::vector<int>& chain_of_edge,
                                          const PatchOutline& outline) {
    std::vector<int> curves;
    size_t first = 0;
    for (const auto& loop : outline) {
      size_t end = first + 1;
      while (boundary.edges[end - 1][1] != static_cast<int>(first)) ++end;
      if (end - first < kFewestLoopEdges)
        for (const CurveSide& s : loop) curves.push_back(s.chain);
      first = end;
    }
    if (!curves.empty() || meshable(boundary)) return curves;
    for (const auto& [i, j] : crossing_edges(boundary)) {
      curves.push_back(chain_of_edge[i]);
      curves.push_back(chain_of_edge[j]);
    }
    if (curves.empty()) curves = chain_of_edge;  // coincident points, or turned inside out
    return curves;
  }

  static bool meshable(const PatchBoundary& boundary) {
    try {
      constrained_delaunay(boundary);
      return true;
    } catch (const InputError&) {
      return false;
    }
  }

  /// Pairs of edges that share a point other than a common end.
  static std::vector<std::pair<size_t, size_t>> crossing_edges(const PatchBoundary& boundary) {
    const auto& p = boundary.points;
    std::vector<Box<Vec2>> boxes;
    for (const auto& [a, b] : boundary.edges) boxes.push_back(Box<Vec2>::around({p[a], p[b]}));
    const BoxTree<Vec2> tree(boxes);
    std::vector<std::pair<size_t, size_t>> pairs;
    for (size_t i = 0; i < boundary.edges.size(); ++i) {
      const auto [a, b] = boundary.edges[i];
      const auto gap = [&](const BoxTree<Vec2>::Node& node) { return boxes[i].overlaps(node.box) ? 0 : 1; };
      tree.search(0.0, gap, [&](int item) {
        const auto j = static_cast<size_t>(item);
        const auto [c, d] = boundary.edges[j];
        if (j >= i || !boxes[i].overlaps(boxes[j]) || a == c || a == d || b == c || b == d) return;
        if (orient2d(p[a], p[b], p[c]) * orient2d(p[a], p[b], p[d]) <= 0 &&
            orient2d(p[c], p[d], p[a]) * orient2d(p[c], p[d], p[b]) <= 0)
          pairs.emplace_back(i, j);
      });
    }
    return pairs;
  }

  SurfaceDomain collect() {
    std::vector<std::shared_ptr<BackgroundMesh>> backgrounds(maps_.size());
    for_each_patch([&](size_t p) { backgrounds[p] = std::make_shared<BackgroundMesh>(maps_[p].flat); });
    SurfaceDomain domain;
    domain.sharp_corners = find_sharp_corners(corners_, chains_, maps_, nodes_, kBadEta);
    domain.boundary.curves = fine_.curves;
    domain.boundary.regions = fine_.regions;
    for (size_t p = 0; p < maps_.size(); ++p) {
      domain.patches.push_back({std::move(maps_[p]), std::move(outlines_[p]), std::move(boundaries_[p]),
                                std::move(backgrounds[p]), std::move(tube_sizes_[p])});
      SurfacePatch& patch = domain.patches[p];
      const DoingFace face(fine_.regions[patch.map.face].tag);
      try {
        cap_patch(static_cast<int>(p), domain);
        seed_narrow_places(patch.boundary);
      } catch (const InputError& error) {
        throw FaceError(patch.map.face, fmt::format("{}: {}", face_name(patch.map), error.what()));
      }
    }
    for (size_t c = 0; c < chains_.size(); ++c) {
      for (size_t i = 0; i + 1 < nodes_.on_curve[c].size(); ++i) {
        domain.boundary.lines.push_back({nodes_.on_curve[c][i].node, nodes_.on_curve[c][i + 1].node});
        domain.boundary.line_curve.push_back(chains_[c].curve);
      }
    }
    domain.boundary.points = nodes_.points;
    domain.chains = std::move(chains_);
    domain.cut_face = std::move(cut_face_);
    domain.nodes = std::move(nodes_);
    domain.warnings = std::move(warnings_);
    return domain;
  }

  /// Nodes of a patch where two curves meet that have it on one side only.
  std::set<int> corners_between_curves(int p) const {
    const auto is_seam = [&](int chain) { return std::ranges::count(demands_[chain].patches, p) > 1; };
    std::set<int> nodes;
    for (const FaceCorner& c : corners_) {
      if (c.patch != p || is_seam(c.before) || is_seam(c.after)) continue;
      const auto& on_curve = nodes_.on_curve[c.after];
      nodes.insert((c.after_ends ? on_curve.back() : on_curve.front()).node);
    }
    return nodes;
  }

  /// Takes pointed tips and sharp corners out of a patch, and the nodes that this drops from their curves.
  void cap_patch(int p, SurfaceDomain& domain) {
    SurfacePatch& patch = domain.patches[p];
    const auto add = [&](const Vec3& x) {
      nodes_.points.push_back(x);
      return static_cast<int>(nodes_.points.size()) - 1;
    };
    int hint = -1;
    auto caps = cap_tips(patch.boundary, [&](Vec2 u) { return add(lift(patch, model_, u, hint)); });
    for (const BoundaryCap& cap : caps)
      for (auto& on_curve : nodes_.on_curve)
        std::erase_if(on_curve, [&](const CurveNode& n) {
          return std::ranges::find(cap.dropped, n.node) != cap.dropped.end();
        });
    const std::set<int> corners = corners_between_curves(p);
    const CapNodes cap_nodes{[&](int node) { return corners.contains(node); },
                             [&](int node) { return nodes_.points[node]; },
                             [&](const Vec3& x, Vec2 u) {
                               return model_.projector ? model_.projector->to_face(patch.map.face, x)
                                                       : lift(patch, model_, u, hint);
                             },
                             [&](Vec2 u) { return fine_normal(patch, fine_, u, hint); }, add};
    for (BoundaryCap& cap : cap_corners(patch.boundary, cap_nodes)) caps.push_back(std::move(cap));
    for (BoundaryCap& cap : caps) domain.caps.push_back({p, std::move(cap)});
  }

  const SurfaceModel& model_;
  const Mesh& fine_;
  const SizeField& size_;
  const SizeField& asked_;  ///< that warnings refer to
  const MatchingSolver& solver_;
  std::vector<FlatPatch> maps_;
  std::vector<int> cut_face_;
  std::vector<CurveChain> chains_;
  std::vector<PatchOutline> outlines_;           ///< of each map
  std::vector<std::vector<double>> tube_sizes_;  ///< at the vertices of each map
  std::vector<FaceCorner> corners_;
  std::optional<AcrossView> across_;
  std::vector<int> group_;  ///< of each curve, those that face each other along strips
  std::vector<SizeIntegral> integrals_;
  std::vector<double> lengths_;  ///< of each curve, in sizes as asked
  std::vector<CurveDemand> demands_;
  SurfaceNodes nodes_;
  std::vector<PatchBoundary> boundaries_;
  size_t crossing_ = 0;  ///< the last map whose boundary crossed itself
  std::vector<Warning> warnings_;
};

}  // namespace

SurfaceDomain make_surface_domain(const SurfaceModel& model, Flattening flattening, const SizeField& size,
                                  const MatchingSolver& solver, const SizeField* asked) {
  return DomainBuilder(model, std::move(flattening), size, solver, asked).build();
}

SurfacePatchSize::SurfacePatchSize(const SurfacePatch& patch, const Mesh& fine, const SurfaceSize& size)
    : patch_(patch), fine_(fine), size_(size) {
  const TriPatch& flat = patch.map.flat;
  std::vector<double> flat_area(flat.points.size(), 0), area(flat.points.size(), 0);
  for (const auto& v : flat.triangles) {
    const Vec3 a = fine.points[patch.map.fine_node[v[0]]], b = fine.points[patch.map.fine_node[v[1]]],
               c = fine.points[patch.map.fine_node[v[2]]];
    const double in_plane =
        cross(flat.points[v[1]] - flat.points[v[0]], flat.points[v[2]] - flat.points[v[0]]);
    const double in_space = norm(cross(b - a, c - a));
    for (const int i : v) flat_area[i] += in_plane, area[i] += in_space;
  }
  for (size_t i = 0; i < area.size(); ++i)
    stretch_.push_back(area[i] > 0 ? std::sqrt(flat_area[i] / area[i]) : 1);
}

double SurfacePatchSize::at(Vec2 u, int& hint) const {
  const auto [t, b] = patch_.background->locate(u, hint);
  const auto& v = patch_.map.flat.triangles[t];
  std::array<int, 3> nodes;
  Vec3 x;
  double stretch = 0, limit = 0;
  for (int k = 0; k < 3; ++k) {
    nodes[k] = patch_.map.fine_node[v[k]];
    if (!patch_.tube_size.empty()) limit += b[k] * patch_.tube_size[v[k]];
    x = x + b[k] * fine_.points[nodes[k]];
    stretch += b[k] * stretch_[v[k]];
  }
  int size_hint = -1;
  const double wanted = size_.on_fine(nodes, b, x, size_hint);
  return stretch * (patch_.tube_size.empty() ? wanted : std::min(wanted, limit));
}

Vec3 fine_place(const SurfacePatch& patch, const Mesh& fine, Vec2 u, int& hint) {
  const auto [t, b] = patch.background->locate(u, hint);
  const auto& v = patch.map.flat.triangles[t];
  Vec3 x;
  for (int k = 0; k < 3; ++k) x = x + b[k] * fine.points[patch.map.fine_node[v[k]]];
  return x;
}

Vec3 fine_normal(const SurfacePatch& patch, const Mesh& fine, Vec2 u, int& hint) {
  const TriPatch& flat = patch.map.flat;
  std::vector<int> around{patch.background->locate(u, hint).triangle};
  for (int ring = 0; ring < 2; ++ring)
    for (size_t i = around.size(); i-- > 0;)
      for (const int t : flat.neighbours[around[i]])
        if (t >= 0 && std::ranges::find(around, t) == around.end()) around.push_back(t);
  Vec3 sum;
  for (const int t : around) {
    const auto x = [&](int k) { return fine.points[patch.map.fine_node[flat.triangles[t][k]]]; };
    sum = sum + cross(x(1) - x(0), x(2) - x(0));
  }
  return sum;
}

Vec3 lift(const SurfacePatch& patch, const SurfaceModel& model, Vec2 u, int& hint) {
  const Vec3 x = fine_place(patch, model.fine, u, hint);
  return model.projector ? model.projector->to_face(patch.map.face, x) : x;
}

}  // namespace delquad
