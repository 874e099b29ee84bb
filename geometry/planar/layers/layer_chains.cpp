#include "geometry/planar/layers/layer_chains.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <stdexcept>
#include <utility>

#include "base/nearest_name.h"
#include "delquad/error.h"

namespace delquad {
namespace {

std::string curve_title(const Entity& curve) {
  return curve.names.empty() ? fmt::format("curve {}", curve.tag) : "'" + curve.names[0] + "'";
}

class ChainFinder {
 public:
  ChainFinder(const PlanarDomain& domain, std::size_t patch, std::span<const LayerSpec> specs,
              const std::vector<int>& of_curve, const std::vector<std::vector<double>>& heights)
      : domain_(domain),
        patch_(domain.patches[patch]),
        specs_(specs),
        of_curve_(of_curve),
        heights_(heights) {
    const std::size_t n = patch_.points.size();
    next_.resize(n);
    before_.resize(n);
    curve_.resize(n);
    for (std::size_t e = 0; e < patch_.edges.size(); ++e) {
      const auto& [a, b] = patch_.edges[e];
      next_[a] = b;
      before_[b] = a;
      curve_[a] = patch_.edge_curve[e];
    }
    n_lines_.resize(domain.boundary.points.size(), 0);
    for (const auto& line : domain.boundary.lines)
      for (const int v : line) ++n_lines_[v];
    for (const int v : domain.on_crack) n_lines_[v] += 2;
    for (const NamedPoint& named : domain.boundary.named_points) named_.insert(named.point);
  }

  LayerChains find() {
    const int n = static_cast<int>(next_.size());
    std::vector<char> seen(n, 0);
    for (int p = 0; p < n; ++p)
      if (spec(p) >= 0 && spec(before_[p]) < 0) add_chain(p, seen);
    for (int p = 0; p < n; ++p)
      if (spec(p) >= 0 && !seen[p]) add_chain(p, seen);
    for (std::size_t c = 0; c < found_.chains.size(); ++c) {
      if (found_.chains[c].is_closed) continue;
      add_wall_after(static_cast<int>(c));
      add_wall_before(static_cast<int>(c));
    }
    return std::move(found_);
  }

 private:
  /// Of the edge from a point.
  int spec(int p) const { return curve_[p] < 0 ? -1 : of_curve_[curve_[p]]; }
  const LayerSpec& spec_of(int s) const { return specs_[static_cast<std::size_t>(s)]; }
  Vec2 at(int p) const { return patch_.points[p]; }

  void add_chain(int first, std::vector<char>& seen) {
    LayerChain chain;
    int p = first;
    for (; spec(p) >= 0 && !seen[p]; p = next_[p]) {
      seen[p] = 1;
      chain.points.push_back(p);
      chain.spec.push_back(spec(p));
    }
    chain.is_closed = p == first;
    if (!chain.is_closed) chain.points.push_back(p);
    for (int k = 0; k < chain.n_points(); ++k) check_point(chain, k);
    found_.chains.push_back(std::move(chain));
  }

  void check_point(const LayerChain& chain, int k) const {
    const auto [a, b] = chain.specs_at(k);
    const Vec2 p = at(chain.points[k]);
    const LayerSpec& one = spec_of(a < 0 ? b : a);
    if (n_lines_[patch_.point_node[chain.points[k]]] != 2)
      throw InputError(
          fmt::format("{}: another curve meets the layer at ({:.6g}, {:.6g}): expected layers on "
                      "curves that only boundaries continue",
                      one.where, p.x, p.y));
    if (a < 0 || b < 0 || heights_[a].size() == heights_[b].size()) return;
    throw InputError(
        fmt::format("{}: {} layers meet {} at ({:.6g}, {:.6g}): expected the same number on curves that meet",
                    one.where, heights_[a].size(), heights_[b].size(), p.x, p.y));
  }

  /// Whether a wall ends at a point inside of it.
  bool is_stop(int p) const {
    const int node = patch_.point_node[p];
    return spec(p) >= 0 || spec(before_[p]) >= 0 || curve_[p] != curve_[before_[p]] || n_lines_[node] != 2 ||
           named_.contains(node) ||
           std::abs(inner_angle(at(before_[p]), at(p), at(next_[p])) - std::numbers::pi) > kLayerCorner;
  }

  void add_wall_after(int c) {
    LayerChain& chain = found_.chains[c];
    std::vector<int> points = {chain.points.back()};
    do points.push_back(next_[points.back()]);
    while (!is_stop(points.back()));
    chain.wall[1] = add_wall(std::move(points));
    found_.walls[chain.wall[1]].chain[0] = c;
  }

  void add_wall_before(int c) {
    LayerChain& chain = found_.chains[c];
    std::vector<int> points = {chain.points.front()};
    do points.push_back(before_[points.back()]);
    while (!is_stop(points.back()));
    std::ranges::reverse(points);
    chain.wall[0] = add_wall(std::move(points));
    found_.walls[chain.wall[0]].chain[1] = c;
  }

  int add_wall(std::vector<int> points) {
    const auto known = std::ranges::find(found_.walls, points, &LayerWall::points);
    const int index = static_cast<int>(known - found_.walls.begin());
    if (known != found_.walls.end()) return index;
    const int curve = curve_[points[0]];
    std::vector<Vec2> places;
    for (const int p : points) places.push_back(at(p));
    if (domain_.places.empty()) {
      found_.walls.push_back({std::move(points), curve, WallTrack(std::move(places), nullptr, {})});
      return index;
    }
    auto [shape, params] = on_curve(points);
    found_.walls.push_back(
        {std::move(points), curve, WallTrack(std::move(places), std::move(shape), std::move(params))});
    return index;
  }

  /// The curve that the points of a wall are on, and where: ends of its piece, or nodes that may slide.
  std::pair<std::shared_ptr<const Curve>, std::vector<double>> on_curve(
      const std::vector<int>& points) const {
    const auto node = [&](int p) { return patch_.point_node[p]; };
    for (const DomainPiece& piece : domain_.pieces) {
      std::vector<double> params;
      for (std::size_t i = 0; i < points.size(); ++i) {
        const std::optional<double> t = param_on(piece, node(points[i]));
        if (!t) break;
        params.push_back(*t);
      }
      if (params.size() == points.size() && is_monotonous(params)) return {piece.shape, std::move(params)};
    }
    throw std::logic_error("a wall is on no curve");
  }

  std::optional<double> param_on(const DomainPiece& piece, int node) const {
    if (node == piece.ends[0]) return piece.from;
    if (node == piece.ends[1]) return piece.to;
    const CurvePlace& place = domain_.places[node];
    const bool is_here = place.curve == piece.shape && place.from == piece.from && place.to == piece.to;
    return is_here ? std::optional(place.t) : std::nullopt;
  }

  static bool is_monotonous(const std::vector<double>& t) {
    return std::ranges::is_sorted(t, std::less_equal()) || std::ranges::is_sorted(t, std::greater_equal());
  }

  const PlanarDomain& domain_;
  const PatchBoundary& patch_;
  std::span<const LayerSpec> specs_;
  const std::vector<int>& of_curve_;
  const std::vector<std::vector<double>>& heights_;
  std::vector<int> next_, before_, curve_;  ///< by point of the patch; the curve: of the edge from it
  std::vector<int> n_lines_;                ///< by node
  std::set<int> named_;                     ///< nodes
  LayerChains found_;
};

/// Curves of which each line has one patch beside it, and none on the other side.
std::vector<char> bounding_curves(const PlanarDomain& domain) {
  std::map<std::pair<int, int>, int> patches;
  for (const PatchBoundary& patch : domain.patches)
    for (const auto& [a, b] : patch.edges) ++patches[std::minmax(patch.point_node[a], patch.point_node[b])];
  const std::set<int> on_crack(domain.on_crack.begin(), domain.on_crack.end());
  std::vector<char> bounds(domain.boundary.curves.size(), 1);
  for (std::size_t l = 0; l < domain.boundary.lines.size(); ++l) {
    const auto& [a, b] = domain.boundary.lines[l];
    if (patches[std::minmax(a, b)] != 1 || (on_crack.contains(a) && on_crack.contains(b)))
      bounds[domain.boundary.line_curve[l]] = 0;
  }
  return bounds;
}

}  // namespace

double inner_angle(Vec2 before, Vec2 at, Vec2 after) {
  const Vec2 in = at - before, out = after - at;
  return std::numbers::pi - std::atan2(cross(in, out), dot(in, out));
}

std::vector<int> layers_of_curves(const PlanarDomain& domain, std::span<const LayerSpec> specs) {
  const std::vector<Entity>& curves = domain.boundary.curves;
  std::vector<std::string> known;
  for (const Entity& curve : curves) known.insert(known.end(), curve.names.begin(), curve.names.end());
  const std::vector<char> bounds = bounding_curves(domain);
  std::vector<int> of_curve(curves.size(), -1);
  for (std::size_t s = 0; s < specs.size(); ++s)
    for (const std::string& name : specs[s].on) {
      if (std::ranges::find(known, name) == known.end())
        throw InputError(
            fmt::format("{}: no curve has the name '{}'{}", specs[s].where, name, suggestion(name, known)));
      for (std::size_t c = 0; c < curves.size(); ++c) {
        if (std::ranges::find(curves[c].names, name) == curves[c].names.end()) continue;
        if (!bounds[c])
          throw InputError(
              fmt::format("{}: {} has mesh on both sides, or is a crack: expected a curve that "
                          "bounds the domain",
                          specs[s].where, curve_title(curves[c])));
        if (of_curve[c] >= 0 && of_curve[c] != static_cast<int>(s))
          throw InputError(fmt::format("{}: {} has a layer already, by {}", specs[s].where,
                                       curve_title(curves[c]), specs[of_curve[c]].where));
        of_curve[c] = static_cast<int>(s);
      }
    }
  return of_curve;
}

LayerChains find_layer_chains(const PlanarDomain& domain, std::size_t patch, std::span<const LayerSpec> specs,
                              const std::vector<int>& of_curve,
                              const std::vector<std::vector<double>>& heights) {
  return ChainFinder(domain, patch, specs, of_curve, heights).find();
}

}  // namespace delquad
