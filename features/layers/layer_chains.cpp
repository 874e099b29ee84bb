// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/layers/layer_chains.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <set>
#include <stdexcept>

#include "base/text.h"
#include "delquad/error.h"
#include "geometry/mesh/entity_names.h"

namespace delquad {

namespace {

/// Curves of which each line has a patch beside it, another one or none on the other side, and no crack.
std::vector<char> bounding_curves(const PlanarDomain& domain) {
  std::map<std::pair<int, int>, std::vector<std::size_t>> patches;
  for (std::size_t p = 0; p < domain.patches.size(); ++p)
    for (const auto& [a, b] : domain.patches[p].edges)
      patches[std::minmax(domain.patches[p].point_node[a], domain.patches[p].point_node[b])].push_back(p);
  const std::set<int> on_crack(domain.on_crack.begin(), domain.on_crack.end());
  std::vector<char> bounds(domain.boundary.curves.size(), 1);
  for (std::size_t l = 0; l < domain.boundary.lines.size(); ++l) {
    const auto& [a, b] = domain.boundary.lines[l];
    const std::vector<std::size_t>& beside = patches[std::minmax(a, b)];
    const bool stands_inside = beside.size() == 2 && beside[0] == beside[1];
    if (beside.empty() || stands_inside || (on_crack.contains(a) && on_crack.contains(b)))
      bounds[domain.boundary.line_curve[l]] = 0;
  }
  return bounds;
}

std::vector<std::set<int>> regions_of_curves(const PlanarDomain& domain) {
  std::vector<std::set<int>> regions(domain.boundary.curves.size());
  for (std::size_t p = 0; p < domain.patches.size(); ++p)
    for (const int curve : domain.patches[p].edge_curve)
      if (curve >= 0) regions[curve].insert(domain.patch_region[p]);
  return regions;
}

std::vector<char> regions_named(const PlanarDomain& domain, const LayerSpec& spec) {
  std::vector<char> into;
  for (const std::string& name : spec.into)
    for (const int r : find_entities(domain.boundary.regions, "region", name, spec.where)) {
      into.resize(domain.boundary.regions.size(), 0);
      into[r] = 1;
    }
  return into;
}

}  // namespace

int CurveLayers::at(int curve, int region) const {
  if (curve < 0) return -1;
  for (const int s : of_curve[curve])
    if (into[s].empty() || into[s][region]) return s;
  return -1;
}

CurveLayers layers_of_curves(const PlanarDomain& domain, std::span<const LayerSpec> specs) {
  const std::vector<Entity>& curves = domain.boundary.curves;
  const std::vector<char> bounds = bounding_curves(domain);
  const std::vector<std::set<int>> regions = regions_of_curves(domain);
  CurveLayers layers{std::vector<std::vector<int>>(curves.size()), {}};
  for (std::size_t s = 0; s < specs.size(); ++s) {
    layers.into.push_back(regions_named(domain, specs[s]));
    const auto goes_into = [&](std::size_t spec, int r) {
      return layers.into[spec].empty() || layers.into[spec][r];
    };
    for (const std::string& name : specs[s].on) {
      bool is_beside = specs[s].into.empty();  // one of the regions
      for (const int c : find_entities(curves, "curve", name, specs[s].where)) {
        std::vector<int>& here = layers.of_curve[c];
        for (const int r : regions[c]) is_beside = is_beside || goes_into(s, r);
        if (std::ranges::find(here, static_cast<int>(s)) != here.end()) continue;
        if (!bounds[c])
          throw InputError(
              fmt::format("{}: {} stands inside of one region, or is a crack: expected a curve that bounds "
                          "a region",
                          specs[s].where, curve_title(curves[c])));
        for (const int r : regions[c]) {
          if (!goes_into(s, r)) continue;
          const auto other =
              std::ranges::find_if(here, [&](int o) { return goes_into(static_cast<std::size_t>(o), r); });
          if (other != here.end())
            throw InputError(fmt::format("{}: {} has a layer already, by {}: expected one of the two",
                                         specs[s].where, curve_title(curves[c]), specs[*other].where));
        }
        here.push_back(static_cast<int>(s));
      }
      if (!is_beside)
        throw InputError(fmt::format("{}: '{}' bounds none of the regions '{}'", specs[s].where, name,
                                     fmt::join(specs[s].into, "', '")));
    }
  }
  return layers;
}

namespace {

/// Whether values are ascending or descending.
bool is_monotonous(const std::vector<double>& t) {
  return std::ranges::is_sorted(t, std::less_equal()) || std::ranges::is_sorted(t, std::greater_equal());
}

std::optional<double> param_on(const DomainPiece& piece, int node) {
  if (node == piece.ends[0]) return piece.from;
  if (node == piece.ends[1]) return piece.to;
  if (piece.nodes.empty()) return std::nullopt;
  // Mostly they follow each other.
  const auto guess = static_cast<std::size_t>(node - piece.nodes[0]);
  if (node >= piece.nodes[0] && guess < piece.nodes.size() && piece.nodes[guess] == node)
    return piece.interior[guess];
  const auto found = std::ranges::find(piece.nodes, node);
  if (found == piece.nodes.end()) return std::nullopt;
  return piece.interior[static_cast<std::size_t>(found - piece.nodes.begin())];
}

/// The piece that nodes of a wall are on, and where.
std::pair<const DomainPiece*, std::vector<double>> piece_with(const PlanarDomain& domain,
                                                              const std::vector<int>& nodes) {
  for (const DomainPiece& piece : domain.pieces) {
    std::vector<double> params;
    for (const int node : nodes) {
      const std::optional<double> t = param_on(piece, node);
      if (!t) break;
      params.push_back(*t);
    }
    if (params.size() == nodes.size() && is_monotonous(params)) return {&piece, std::move(params)};
  }
  throw std::logic_error("a wall is on no curve");
}

class ChainFinder {
 public:
  ChainFinder(const PlanarDomain& domain, std::size_t patch, std::span<const LayerSpec> specs,
              const CurveLayers& layers, const BoundaryGraph& graph)
      : domain_(domain),
        index_(patch),
        patch_(domain.patches[patch]),
        specs_(specs),
        graph_(graph),
        next_(patch_.points.size()),
        before_(patch_.points.size()),
        spec_(patch_.points.size()),
        curve_(patch_.points.size()) {
    std::set<int> nodes;
    for (const int v : patch_.point_node)
      if (!nodes.insert(v).second) repeated_.insert(v);
    for (std::size_t e = 0; e < patch_.edges.size(); ++e) {
      const auto& [a, b] = patch_.edges[e];
      next_[a] = b;
      before_[b] = a;
      curve_[a] = patch_.edge_curve[e];
      spec_[a] = layers.at(patch_.edge_curve[e], domain.patch_region[patch]);
    }
  }

  LayerChains find() {
    const int n = static_cast<int>(next_.size());
    std::vector<char> seen(n, 0);
    for (int p = 0; p < n; ++p)
      if (spec_[p] >= 0 && spec_[before_[p]] < 0) add_chain(p, seen);
    for (int p = 0; p < n; ++p)
      if (spec_[p] >= 0 && !seen[p]) add_chain(p, seen);
    for (std::size_t c = 0; c < found_.chains.size(); ++c) {
      if (found_.chains[c].is_closed) continue;
      add_wall(static_cast<int>(c), true);
      add_wall(static_cast<int>(c), false);
    }
    return std::move(found_);
  }

 private:
  void add_chain(int first, std::vector<char>& seen) {
    LayerChain chain;
    int p = first;
    for (; spec_[p] >= 0 && !seen[p]; p = next_[p]) {
      seen[p] = 1;
      chain.points.push_back(p);
      chain.spec.push_back(spec_[p]);
    }
    chain.is_closed = p == first;
    if (!chain.is_closed) chain.points.push_back(p);
    for (const int point : chain.points) check_point(chain, point);
    found_.chains.push_back(std::move(chain));
  }

  const std::string& where(const LayerChain& chain) const {
    return specs_[static_cast<std::size_t>(chain.spec[0])].where;
  }

  void check_point(const LayerChain& chain, int p) const {
    const int node = patch_.point_node[p];
    const auto is_cut = [&](int curve) {
      return domain_.in_space != nullptr && domain_.in_space->is_cut(curve);
    };
    if (!repeated_.contains(node) && !graph_.is_on_crack(node)) return;
    if (is_cut(curve_[p]) || is_cut(curve_[before_[p]])) return;
    throw InputError(
        fmt::format("{}: another curve meets the layer inside of its region at {}: expected "
                    "boundaries of regions alone; an inner curve may begin beyond the layers",
                    where(chain), show_node(domain_, node)));
  }

  /// Whether a wall ends at a point inside of it.
  bool is_stop(int p) const {
    return spec_[p] >= 0 || spec_[before_[p]] >= 0 || graph_.stops(patch_.point_node[p]);
  }

  /// The wall that follows on a chain, or leads to it.
  void add_wall(int c, bool follows) {
    LayerChain& chain = found_.chains[c];
    const std::vector<int>& step = follows ? next_ : before_;
    std::vector<int> points = {follows ? chain.points.back() : chain.points.front()};
    do points.push_back(step[points.back()]);
    while (!is_stop(points.back()));
    if (!follows) std::ranges::reverse(points);
    const auto known = std::ranges::find(found_.walls, points, &LayerWall::points);
    const int index = static_cast<int>(known - found_.walls.begin());
    if (known == found_.walls.end())
      found_.walls.push_back(make_layer_wall(domain_, index_, std::move(points), graph_, where(chain)));
    chain.wall[follows] = index;
    found_.walls[index].chain[!follows] = c;
  }

  const PlanarDomain& domain_;
  const std::size_t index_;
  const PatchBoundary& patch_;
  std::span<const LayerSpec> specs_;
  const BoundaryGraph& graph_;
  /// By point of the patch; layer and curve: of the edge from it.
  std::vector<int> next_, before_, spec_, curve_;
  std::set<int> repeated_;  ///< nodes for which several points stand
  LayerChains found_;
};

}  // namespace

LayerChains find_layer_chains(const PlanarDomain& domain, std::size_t patch, std::span<const LayerSpec> specs,
                              const CurveLayers& layers, const BoundaryGraph& graph) {
  return ChainFinder(domain, patch, specs, layers, graph).find();
}

LayerWall make_layer_wall(const PlanarDomain& domain, std::size_t patch, std::vector<int> points,
                          const BoundaryGraph& graph, const std::string& where) {
  const PatchBoundary& boundary = domain.patches[patch];
  std::vector<int> nodes;
  std::vector<Vec2> places;
  for (const int p : points) {
    nodes.push_back(boundary.point_node[p]);
    places.push_back(boundary.points[p]);
  }
  const auto edge = graph.edge_from(nodes[0], nodes[1]);
  const int curve = boundary.edge_curve[(*edge)[1]];
  const auto refuse_divided = [&] {
    throw InputError(
        fmt::format("{}: the layer ends on {} at {}, of which 'divide' gives the number of edges: expected "
                    "one of the two [layer-at-a-divided-curve]",
                    where, curve_title(domain.boundary.curves[curve]), show_node(domain, nodes[0])));
  };
  if (domain.in_space != nullptr) {
    if (domain.in_space->is_divided(nodes[0], nodes[1])) refuse_divided();
    for (std::size_t i = 0; i + 1 < nodes.size(); ++i)
      if (graph.branches(nodes[i], nodes[i + 1]))
        throw InputError(
            fmt::format("{}: the layer ends on {} at {}, where more than two faces meet: expected "
                        "layers 'into' other faces",
                        where, curve_title(domain.boundary.curves[curve]), show_node(domain, nodes[i])));
    const int p = static_cast<int>(patch);
    return {std::move(points),
            curve,
            WallTrack(std::move(places), std::move(nodes), *domain.in_space, p),
            {-1, -1},
            domain.in_space->is_axis(p, curve)};
  }
  if (domain.places.empty()) return {std::move(points), curve, WallTrack(std::move(places), nullptr, {})};
  auto [piece, params] = piece_with(domain, nodes);
  if (piece->is_divided) refuse_divided();
  return {std::move(points), curve, WallTrack(std::move(places), piece->shape, std::move(params))};
}

WallTrack::WallTrack(std::vector<Vec2> points, std::shared_ptr<const Curve> curve, std::vector<double> params)
    : points_(std::move(points)), curve_(std::move(curve)), params_(std::move(params)) {
  measure();
}

WallTrack::WallTrack(std::vector<Vec2> points, std::vector<int> nodes, const PatchPlaces& places, int patch)
    : points_(std::move(points)), nodes_(std::move(nodes)), in_space_(&places), patch_(patch) {
  measure();
}

void WallTrack::measure() {
  Vec3 last = spot(0);
  for (int i = 1; i <= kSamples * n_edges(); ++i) {
    const Vec3 next = spot(static_cast<double>(i) / kSamples);
    length_.push_back(length_.back() + norm(next - last));
    last = next;
  }
}

double WallTrack::place(double length) const {
  const auto above = std::upper_bound(length_.begin() + 1, length_.end() - 1, length);
  const auto i = above - length_.begin();
  const double part = (length - length_[i - 1]) / (length_[i] - length_[i - 1]);
  return (static_cast<double>(i - 1) + std::clamp(part, 0.0, 1.0)) / kSamples;
}

std::pair<std::size_t, double> WallTrack::edge_at(double place) const {
  const auto edge = static_cast<std::size_t>(std::min(std::floor(place), n_edges() - 1.0));
  return {edge, place - static_cast<double>(edge)};
}

Vec2 WallTrack::point(double place) const {
  const auto [edge, part] = edge_at(place);
  if (part == 0) return points_[edge];
  if (part == 1) return points_[edge + 1];
  if (curve_) return curve_->point(param(place));
  const Vec2 near = straight(edge, part);
  return in_space_ == nullptr ? near : in_space_->in_plane(patch_, spot(place), near);
}

Vec3 WallTrack::spot(double place) const {
  const auto [edge, part] = edge_at(place);
  if (in_space_ != nullptr)
    return in_space_->between(nodes_[edge], nodes_[edge + 1], part, patch_, straight(edge, part));
  const Vec2 p = point(place);
  return {p.x, p.y, 0};
}

double WallTrack::param(double place) const {
  const auto [edge, part] = edge_at(place);
  return std::lerp(params_[edge], params_[edge + 1], part);
}

BoundaryGraph::BoundaryGraph(const PlanarDomain& domain)
    : stops_(domain.boundary.points.size(), 0), on_crack_(domain.boundary.points.size(), 0) {
  for (const int v : domain.on_crack) on_crack_[v] = 1;
  for (std::size_t p = 0; p < domain.patches.size(); ++p) {
    const PatchBoundary& patch = domain.patches[p];
    for (std::size_t e = 0; e < patch.edges.size(); ++e) {
      const auto& [a, b] = patch.edges[e];
      const int from = patch.point_node[a], to = patch.point_node[b];
      const std::array at{static_cast<int>(p), static_cast<int>(e)};
      if (!edges_.insert_or_assign({from, to}, at).second) branching_.insert(std::minmax(from, to));
    }
  }
  find_stops(domain);
  share_stops(domain);
}

std::optional<std::array<int, 2>> BoundaryGraph::edge_from(int a, int b) const {
  const auto found = edges_.find({a, b});
  return found == edges_.end() ? std::nullopt : std::optional(found->second);
}

void BoundaryGraph::find_stops(const PlanarDomain& domain) {
  std::set<std::pair<int, int>> edges;
  for (const auto& [edge, where] : edges_) edges.insert(std::minmax(edge.first, edge.second));
  for (const auto& [a, b] : domain.boundary.lines) edges.insert(std::minmax(a, b));
  std::vector<int> degree(stops_.size(), 0);
  for (const auto& [a, b] : edges) ++degree[a], ++degree[b];
  for (std::size_t v = 0; v < stops_.size(); ++v)
    stops_[v] = degree[v] != 2 || on_crack_[v] ||
                (domain.in_space != nullptr && domain.in_space->is_end(static_cast<int>(v)));
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
  }
}

std::string show_node(const PlanarDomain& domain, int node) {
  const Vec3& x = domain.boundary.points[static_cast<std::size_t>(node)];
  return domain.in_space != nullptr ? show_point(x) : show_point(Vec2{x.x, x.y});
}

double inner_angle(Vec2 before, Vec2 at, Vec2 after) {
  const Vec2 in = at - before, out = after - at;
  return std::numbers::pi - std::atan2(cross(in, out), dot(in, out));
}

}  // namespace delquad
