// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "base/segment.h"
#include "delquad/error.h"
#include "features/layers/add_layers.h"
#include "features/symmetry/mirrored_surface.h"
#include "geometry/mesh/entity_names.h"
#include "geometry/mesh/triangle_measures.h"
#include "geometry/patches/narrow_places.h"
#include "geometry/patches/surface_curves.h"

namespace delquad {
namespace {

/// Searches for a distance in space end at this part of it, or after so many steps.
constexpr double kSameLength = 1e-11;
constexpr int kMostSteps = 8;
/// A triangle of so many times the area of its neighbor has the better directions.
constexpr double kMuchLarger = 4;

class SurfacePlaces final : public PatchPlaces {
 public:
  SurfacePlaces(const SurfaceModel& model, const SurfaceDomain& domain, const SymmetricHalf* part)
      : model_(model), domain_(domain), part_(part), hint_(domain.patches.size(), -1) {
    for (std::size_t c = 0; c < domain.nodes.on_curve.size(); ++c) {
      const std::vector<CurveNode>& on_curve = domain.nodes.on_curve[c];
      for (std::size_t k = 0; k + 1 < on_curve.size(); ++k)
        edges_[std::minmax(on_curve[k].node, on_curve[k + 1].node)] = {static_cast<int>(c), on_curve[k],
                                                                       on_curve[k + 1]};
      ends_.insert({on_curve.front().node, on_curve.back().node});
    }
    for (const PeriodicNodes& pair : domain.boundary.periodic) is_periodic_.insert({pair.curve, pair.master});
  }

  double stretch(int patch, Vec2 u, Vec2 along) const override {
    const auto [a, b] = axes(patch, u);
    return 1 / norm(along.x * a + along.y * b);
  }

  PatchPlace next(int patch, const PatchPlace& from, Vec2 along, double length) const override {
    const auto [a, b] = axes(patch, from.u);
    const Vec3 foot = place(patch, from.u);
    PatchPlace to;
    double part = 1;
    for (int step = 0; step < kMostSteps; ++step) {
      to.u = from.u + part * along;
      to.x = from.x + (model_.projector ? part * (along.x * a + along.y * b) : place(patch, to.u) - foot);
      to.x = to_face(patch, to.x);
      const double ratio = length / norm(to.x - from.x);
      if (!(std::abs(ratio - 1) > kSameLength) || !std::isfinite(ratio)) break;
      part *= ratio;
    }
    return to;
  }

  Vec2 in_plane(int patch, const Vec3& x, Vec2 near) const override {
    const auto [a, b] = axes(patch, near);
    const Vec3 d = x - place(patch, near);
    const double aa = dot(a, a), ab = dot(a, b), bb = dot(b, b);
    const double da = dot(d, a), db = dot(d, b), area2 = aa * bb - ab * ab;
    return near + Vec2{(bb * da - ab * db) / area2, (aa * db - ab * da) / area2};
  }

  Vec3 between(int a, int b, double part, int patch, Vec2 straight) const override {
    if (part == 0) return domain_.nodes.points[a];
    if (part == 1) return domain_.nodes.points[b];
    const CurveChain& chain = domain_.chains[chain_of(a, b)];
    if (is_cut(chain.curve)) return to_face(patch, place(patch, straight));
    return place_on_curve(model_, chain, domain_.cut_face, s_between(a, b, part));
  }

  bool is_cut(int curve) const override { return domain_.cut_face[curve] >= 0; }
  bool is_axis(int patch, int curve) const override {
    return part_ != nullptr && curve < static_cast<int>(part_->curve_planes.size()) &&
           (part_->curve_planes[curve] & ~part_->face_planes[domain_.patches[patch].map.face]) != 0;
  }
  bool is_end(int node) const override { return ends_.contains(node); }
  bool is_divided(int a, int b) const override {
    const int chain = chain_of(a, b);
    return domain_.chain_stays[chain] != 0 && !is_periodic_.contains(domain_.chains[chain].curve);
  }

  int chain_of(int a, int b) const { return edges_.at(std::minmax(a, b)).chain; }
  double s_between(int a, int b, double part) const {
    const Edge& edge = edges_.at(std::minmax(a, b));
    return edge.from.node == a ? std::lerp(edge.from.s, edge.to.s, part)
                               : std::lerp(edge.to.s, edge.from.s, part);
  }
  /// Returns where the curve from a to b is nearest to a point.
  double s_near(int a, int b, const Vec3& x) const {
    const Edge& edge = edges_.at(std::minmax(a, b));
    const CurveChain& chain = domain_.chains[edge.chain];
    double s = edge.from.s, distance = std::numeric_limits<double>::max();
    for (double from = edge.from.s, to; from < edge.to.s; from = to) {
      to = std::min(std::floor(from) + 1, edge.to.s);
      const Vec3 p = fine_point_at(model_.fine, chain, from), way = fine_point_at(model_.fine, chain, to) - p;
      const double part = nearest_part(x, p, p + way);
      if (const double d = norm(p + part * way - x); d < distance)
        distance = d, s = from + part * (to - from);
    }
    return s;
  }

 private:
  struct Edge {
    int chain;
    CurveNode from, to;
  };

  Vec3 to_face(int patch, const Vec3& x) const {
    return model_.projector ? model_.projector->to_face(domain_.patches[patch].map.face, x) : x;
  }

  /// The place of u on the fine triangles, which go on beyond the patch.
  Vec3 place(int patch, Vec2 u) const {
    const SurfacePatch& on = domain_.patches[patch];
    const auto [t, weights] = on.background->locate(u, hint_[patch]);
    Vec3 x;
    Vec2 beyond = u;
    for (int k = 0; k < 3; ++k) {
      const int v = on.map.flat.triangles[t][k];
      x = x + weights[k] * model_.fine.points[on.map.fine_node[v]];
      beyond = beyond - weights[k] * on.map.flat.points[v];
    }
    const auto [a, b] = axes(patch, u);
    return x + beyond.x * a + beyond.y * b;
  }

  /// The derivatives of the place at u. Slivers at the boundary may stand on edge: much larger neighbors
  /// count.
  std::array<Vec3, 2> axes(int patch, Vec2 u) const {
    const SurfacePatch& on = domain_.patches[patch];
    const TriPatch& flat = on.map.flat;
    const auto area = [&](int t) { return t < 0 ? 0 : area_vector(flat.points, flat.triangles[t]); };
    int at = on.background->locate(u, hint_[patch]).triangle;
    for (int last = -1; last != at;) {
      last = at;
      for (const int t : flat.neighbours[last])
        if (area(t) > std::max(kMuchLarger * area(last), area(at))) at = t;
    }
    return tangents(on, model_.fine, at);
  }

  const SurfaceModel& model_;
  const SurfaceDomain& domain_;
  const SymmetricHalf* part_;
  mutable std::vector<int> hint_;              ///< of each patch
  std::map<std::pair<int, int>, Edge> edges_;  ///< between neighboring nodes
  std::set<int> ends_;                         ///< of curves
  std::set<int> is_periodic_;                  ///< curves with nodes that are images or have them
};

/// Replaces the nodes of a wall on its curve.
void place_wall(const WallNodes& wall, const SurfacePlaces& places, SurfaceDomain& domain) {
  const std::vector<int>& old = wall.old;
  const int chain = places.chain_of(old[0], old[1]);
  std::vector<std::pair<double, int>> nodes;
  for (const auto& [node, place] : wall.places)
    if (node != old.front() && node != old.back()) nodes.emplace_back(place, node);
  std::ranges::sort(nodes);
  const bool forward = places.s_between(old[0], old[1], 0) < places.s_between(old[0], old[1], 1);
  if (!forward) std::ranges::reverse(nodes);
  std::vector<CurveNode> fresh;
  for (const auto& [place, node] : nodes) {
    const auto edge = std::min(static_cast<std::size_t>(place), old.size() - 2);
    const int a = old[edge], b = old[edge + 1];
    const double s = places.is_cut(domain.chains[chain].curve)
                         ? places.s_near(a, b, domain.nodes.points[node])
                         : places.s_between(a, b, place - static_cast<double>(edge));
    fresh.push_back({fresh.empty() ? s : std::max(s, fresh.back().s), node});
  }
  std::vector<CurveNode>& on_curve = domain.nodes.on_curve[chain];
  std::erase_if(on_curve, [&](const CurveNode& node) {
    return std::find(old.begin() + 1, old.end() - 1, node.node) != old.end() - 1;
  });
  const auto first = std::ranges::find(on_curve, forward ? old.front() : old.back(), &CurveNode::node);
  on_curve.insert(first + 1, fresh.begin(), fresh.end());
  domain.chain_stays[chain] = 1;
}

/// Throws InputError if images of marked entities are not marked. `images` returns the images of each.
template <class Images>
void check_marks_symmetric(const std::vector<char>& marked, const Images& images,
                           const std::vector<std::string>& titles, const LayerSpec& layer) {
  for (std::size_t one = 0; one < marked.size(); ++one)
    for (const int other : images(one))
      if (marked[one] && !marked[other])
        throw InputError(
            fmt::format("{}: {} and {} are mirror images and have not the same layer: expected it on both",
                        layer.where, titles[one], titles[other]));
}

}  // namespace

std::vector<LayerSpec> layers_of_part(std::span<const LayerSpec> layers, const CutSurface& surface) {
  const Mesh& whole = surface.whole.fine;
  std::vector<std::string> curves, faces;
  for (const Entity& curve : whole.curves) curves.push_back(curve_title(curve));
  for (const Entity& face : whole.regions) faces.push_back(fmt::format("face {}", face.tag));
  std::vector<LayerSpec> of_part(layers.begin(), layers.end());
  for (LayerSpec& layer : of_part) {
    const std::vector<char> on = layered_curves(whole, {&layer, 1});
    std::vector<char> into(whole.regions.size(), 0);
    for (const std::string& name : layer.into)
      for (const int f : find_entities(whole.regions, "region", name, layer.where)) into[f] = 1;
    for (const MirrorMatch& match : surface.matches) {
      check_marks_symmetric(
          on, [&](auto c) { return match.curves[c]; }, curves, layer);
      check_marks_symmetric(
          into, [&](auto f) { return std::array{match.face[f]}; }, faces, layer);
    }
    layer.on.clear();
    for (std::size_t c = 0; c < surface.half.whole_curve.size(); ++c)
      if (const int of = surface.half.whole_curve[c]; of >= 0 && on[of])
        layer.on.push_back(fmt::format("curve_{}", surface.half.model.fine.curves[c].tag));
  }
  return of_part;
}

std::vector<LocalSize> put_layers(std::span<const LayerSpec> layers, const MappedSpec& grids,
                                  const SurfaceModel& model, const SymmetricHalf* part, SurfaceDomain& domain,
                                  MeshingSetup& p) {
  PlanarDomain view;
  view.boundary = domain.boundary;
  view.mapped = domain.mapped;
  for (const SurfacePatch& patch : domain.patches) {
    view.patches.push_back(patch.boundary);
    view.patch_region.push_back(patch.map.face);
  }
  for (const auto& lips : model.lips)
    for (std::size_t c = 0; c < domain.chains.size(); ++c)
      if (std::ranges::find(lips, domain.chains[c].curve) != lips.end())
        for (const CurveNode& node : domain.nodes.on_curve[c]) view.on_crack.push_back(node.node);
  const SurfacePlaces places(model, domain, part);
  view.in_space = &places;
  const std::vector<LocalSize> fine = put_layers(layers, grids, view, p);
  const std::vector<char> is_layered = layered_curves(model.fine, layers);
  for (std::size_t c = 0; c < domain.chains.size(); ++c)
    if (is_layered[domain.chains[c].curve]) domain.chain_stays[c] = 1;
  domain.nodes.points = view.boundary.points;
  for (const WallNodes& wall : p.layers->walls) place_wall(wall, places, domain);
  for (const int changed : p.layers->patches) {
    PatchBoundary& boundary = domain.patches[changed].boundary;
    boundary = std::move(view.patches[changed]);
    seed_narrow_places(boundary);
  }
  domain.mapped = std::move(view.mapped);
  domain.boundary = boundary_mesh(model.fine, domain.chains, domain.nodes);
  domain.boundary.periodic = std::move(view.boundary.periodic);
  domain.boundary.quads = std::move(view.boundary.quads);
  domain.boundary.quad_region = std::move(view.boundary.quad_region);
  return fine;
}

}  // namespace delquad
