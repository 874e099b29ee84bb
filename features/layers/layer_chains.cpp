#include "features/layers/layer_chains.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <optional>
#include <set>
#include <stdexcept>
#include <utility>

#include "base/text.h"
#include "delquad/error.h"
#include "geometry/mesh/entity_names.h"

namespace delquad {
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
        spec_(patch_.points.size()) {
    std::set<int> nodes;
    for (const int v : patch_.point_node)
      if (!nodes.insert(v).second) repeated_.insert(v);
    for (std::size_t e = 0; e < patch_.edges.size(); ++e) {
      const auto& [a, b] = patch_.edges[e];
      next_[a] = b;
      before_[b] = a;
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
      add_wall_after(static_cast<int>(c));
      add_wall_before(static_cast<int>(c));
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
    if (!repeated_.contains(node) && !graph_.is_on_crack(node)) return;
    throw InputError(
        fmt::format("{}: another curve meets the layer inside of its region at {}: expected "
                    "layers beside which only boundaries of regions go on",
                    where(chain), show_point(patch_.points[p])));
  }

  /// Whether a wall ends at a point inside of it.
  bool is_stop(int p) const {
    return spec_[p] >= 0 || spec_[before_[p]] >= 0 || graph_.stops(patch_.point_node[p]);
  }

  void add_wall_after(int c) {
    LayerChain& chain = found_.chains[c];
    std::vector<int> points = {chain.points.back()};
    do points.push_back(next_[points.back()]);
    while (!is_stop(points.back()));
    chain.wall[1] = add_wall(std::move(points), where(chain));
    found_.walls[chain.wall[1]].chain[0] = c;
  }

  void add_wall_before(int c) {
    LayerChain& chain = found_.chains[c];
    std::vector<int> points = {chain.points.front()};
    do points.push_back(before_[points.back()]);
    while (!is_stop(points.back()));
    std::ranges::reverse(points);
    chain.wall[0] = add_wall(std::move(points), where(chain));
    found_.walls[chain.wall[0]].chain[1] = c;
  }

  int add_wall(std::vector<int> points, const std::string& where) {
    const auto known = std::ranges::find(found_.walls, points, &LayerWall::points);
    const int index = static_cast<int>(known - found_.walls.begin());
    if (known == found_.walls.end())
      found_.walls.push_back(make_layer_wall(domain_, index_, std::move(points), graph_, where));
    return index;
  }

  const PlanarDomain& domain_;
  const std::size_t index_;
  const PatchBoundary& patch_;
  std::span<const LayerSpec> specs_;
  const BoundaryGraph& graph_;
  std::vector<int> next_, before_, spec_;  ///< by point of the patch; the layer: of the edge from it
  std::set<int> repeated_;                 ///< nodes for which several points stand
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
  const bool is_axis = graph.is_on_axis(nodes[0], nodes[1]);
  if (domain.places.empty())
    return {std::move(points), curve, WallTrack(std::move(places), nullptr, {}), {-1, -1}, is_axis};
  auto [piece, params] = piece_with(domain, nodes);
  if (piece->is_divided)
    throw InputError(
        fmt::format("{}: the layer ends on {} at {}, of which 'divide' gives the number of edges: expected "
                    "one of the two",
                    where, curve_title(domain.boundary.curves[curve]), show_point(places[0])));
  return {std::move(points),
          curve,
          WallTrack(std::move(places), piece->shape, std::move(params)),
          {-1, -1},
          is_axis};
}

}  // namespace delquad
