#include "geometry/planar/layers/layer_builder.h"

#include <algorithm>
#include <cmath>

namespace delquad {

LayerBuilder::LayerBuilder(PlanarDomain& domain, std::size_t patch, const LayerColumns& layers)
    : domain_(domain),
      patch_(domain.patches[patch]),
      region_(domain.patch_region[patch]),
      layers_(layers),
      curve_(patch_.points.size()),
      columns_(layers.n_chains()) {
  for (std::size_t e = 0; e < patch_.edges.size(); ++e) curve_[patch_.edges[e][0]] = patch_.edge_curve[e];
  const int n_walls = static_cast<int>(layers_.found().walls.size());
  for (int c = 0; c < layers_.n_chains(); ++c) add_columns(c);
  for (int w = 0; w < n_walls; ++w) add_wall(w);
  make_even();
  for (int w = 0; w < n_walls; ++w) place_wall(w);
  for (int c = 0; c < layers_.n_chains(); ++c) add_quads(c);
}

int LayerBuilder::add_node(Vec2 at) {
  std::vector<Vec3>& points = domain_.boundary.points;
  const double z = points[0].z;
  points.push_back({at.x, at.y, z});
  if (!domain_.places.empty()) domain_.places.emplace_back();
  return static_cast<int>(points.size()) - 1;
}

void LayerBuilder::add_columns(int c) {
  const auto& columns = layers_.columns(c);
  for (int a = 0; a < static_cast<int>(columns.size()); ++a) {
    const int foot = patch_.point_node[columns[a].point];
    if (!domain_.places.empty()) domain_.places[foot] = {};
    std::vector<int> nodes = {foot};
    for (int i = 1; i <= layers_.n_layers(c); ++i) nodes.push_back(add_node(layers_.node(c, {a, i})));
    columns_[c].push_back(std::move(nodes));
  }
}

bool LayerBuilder::ends_free(int c, int end) const {
  const LayerChain& chain = layers_.chain(c);
  return !chain.is_closed &&
         layers_.corner(c, end == 0 ? 0 : chain.n_points() - 1).kind == ChainCorner::kOpenEnd;
}

/// Beside a free end of layers a wall has as many nodes, as far apart.
LayerBuilder::WallSide LayerBuilder::wall_side(int w, int end) {
  const LayerWall& wall = layers_.found().walls[w];
  const int node = patch_.point_node[end == 0 ? wall.points.front() : wall.points.back()];
  const int c = wall.chain[end];
  if (c < 0) return {{node}};
  // The wall begins where the chain ends.
  const int at = end == 0 ? layers_.chain(c).n_points() - 1 : 0;
  if (!ends_free(c, 1 - end)) {
    const LayerColumn& column = end == 0 ? layers_.columns(c).back() : layers_.columns(c).front();
    return {end == 0 ? columns_[c].back() : columns_[c].front(), column.slant * layers_.thickness(c, at),
            true};
  }
  WallSide side{{node}, layers_.thickness(c, at)};
  for (int i = 1; i <= layers_.n_layers(c); ++i) {
    const double along = layers_.height(c, at, i);
    side.nodes.push_back(
        add_node(wall.track.point(wall.track.place(end == 0 ? along : wall.track.length() - along))));
  }
  return side;
}

void LayerBuilder::add_wall(int w) {
  const WallTrack& track = layers_.found().walls[w].track;
  WallNodes nodes{{wall_side(w, 0), wall_side(w, 1)}};
  nodes.from = track.place(nodes.sides[0].along);
  nodes.to = nodes.sides[1].along > 0 ? track.place(track.length() - nodes.sides[1].along) : track.n_edges();
  nodes.n = std::max(1, static_cast<int>(std::lround(nodes.to - nodes.from)));
  walls_.push_back(std::move(nodes));
}

/// A longer wall notices an edge more the least.
void LayerBuilder::make_even() {
  if (walls_.empty()) return;
  std::size_t edges = patch_.edges.size();
  for (int c = 0; c < layers_.n_chains(); ++c) {
    const LayerChain& chain = layers_.chain(c);
    edges -= static_cast<std::size_t>(chain.is_closed ? chain.n_points() : chain.n_points() - 1);
    layers_.for_each_pair(c, [&](int, int) { ++edges; });
    for (const int end : {0, 1})
      edges += ends_free(c, end) ? static_cast<std::size_t>(layers_.n_layers(c)) : 0;
  }
  for (std::size_t w = 0; w < walls_.size(); ++w) {
    edges += static_cast<std::size_t>(walls_[w].n) - (layers_.found().walls[w].points.size() - 1);
    for (const WallSide& side : walls_[w].sides) edges += side.is_front ? 0 : side.nodes.size() - 1;
  }
  if (edges % 2 != 0) ++std::ranges::max_element(walls_, {}, &WallNodes::n)->n;
}

void LayerBuilder::place_wall(int w) {
  const WallTrack& track = layers_.found().walls[w].track;
  WallNodes& wall = walls_[w];
  for (int k = 1; k < wall.n; ++k) {
    const double place = wall.from + (wall.to - wall.from) * k / wall.n;
    wall.nodes.push_back(add_node(track.point(place)));
    if (domain_.places.empty()) continue;
    const auto [low, high] = std::minmax({track.param(wall.from), track.param(wall.to)});
    domain_.places.back() = {track.curve(), track.param(place), low, high};
  }
}

void LayerBuilder::add_quads(int c) {
  layers_.for_each_quad(c, [&](const std::array<ColumnNode, 4>& quad) {
    std::array<int, 4> nodes;
    for (int i = 0; i < 4; ++i) nodes[i] = columns_[c][quad[i].column][quad[i].layer];
    domain_.boundary.quads.push_back(nodes);
    domain_.boundary.quad_region.push_back(region_);
  });
}

/// Each begins at a point where a chain or wall does, or none of them is.
std::vector<std::vector<int>> LayerBuilder::loops() const {
  std::vector<int> next(patch_.points.size());
  for (const auto& [a, b] : patch_.edges) next[a] = b;
  std::vector<char> seen(next.size(), 0), inside(next.size(), 0);
  const auto mark = [&](const std::vector<int>& points, bool is_closed) {
    for (std::size_t i = 1; i + (is_closed ? 0 : 1) < points.size(); ++i) inside[points[i]] = 1;
  };
  for (const LayerChain& chain : layers_.found().chains) mark(chain.points, chain.is_closed);
  for (const LayerWall& wall : layers_.found().walls) mark(wall.points, false);
  std::vector<std::vector<int>> loops;
  for (std::size_t first = 0; first < next.size(); ++first) {
    if (seen[first]) continue;
    int start = static_cast<int>(first);
    while (inside[start]) start = next[start];
    std::vector<int>& loop = loops.emplace_back();
    for (int p = start; !seen[p]; p = next[p]) {
      seen[p] = 1;
      if (!inside[p]) loop.push_back(p);
    }
  }
  return loops;
}

PatchBoundary LayerBuilder::boundary(bool with_layers) const {
  std::vector<int> chain_at(patch_.points.size(), -1), wall_at = chain_at;
  const LayerChains& found = layers_.found();
  for (std::size_t c = 0; c < found.chains.size(); ++c)
    chain_at[found.chains[c].points[0]] = static_cast<int>(c);
  for (std::size_t w = 0; w < found.walls.size(); ++w)
    wall_at[found.walls[w].points[0]] = static_cast<int>(w);
  PatchBoundary result;
  for (const std::vector<int>& starts : loops()) {
    std::vector<LoopPoint> loop;
    for (const int p : starts) {
      if (chain_at[p] >= 0) {
        add_chain(chain_at[p], with_layers, loop);
      } else if (wall_at[p] >= 0) {
        add_wall_points(wall_at[p], with_layers, loop);
      } else {
        loop.push_back({patch_.points[p], patch_.point_node[p], curve_[p]});
      }
    }
    const int n = static_cast<int>(loop.size()), base = static_cast<int>(result.points.size());
    for (int i = 0; i < n; ++i) {
      result.points.push_back(loop[i].at);
      result.point_node.push_back(loop[i].node);
      result.edges.push_back({base + i, base + (i + 1) % n});
      result.edge_curve.push_back(loop[i].curve);
    }
  }
  return result;
}

LayerBuilder::LoopPoint LayerBuilder::node_point(int node, int curve) const {
  const Vec3& p = domain_.boundary.points[node];
  return {{p.x, p.y}, node, curve};
}

/// All but the last point of a chain that is open.
void LayerBuilder::add_chain(int c, bool with_layers, std::vector<LoopPoint>& loop) const {
  if (!with_layers) return add_front(c, loop);
  const LayerChain& chain = layers_.chain(c);
  for (int k = 0; k + (chain.is_closed ? 0 : 1) < chain.n_points(); ++k) {
    const int p = chain.points[k];
    loop.push_back({patch_.points[p], patch_.point_node[p], curve_[p]});
  }
}

void LayerBuilder::add_front(int c, std::vector<LoopPoint>& loop) const {
  const auto& columns = columns_[c];
  const std::size_t n = columns[0].size() - 1;
  if (ends_free(c, 0))
    for (std::size_t i = 0; i < n; ++i) loop.push_back(node_point(columns.front()[i], -1));
  const bool ends_on_wall = !layers_.chain(c).is_closed && !ends_free(c, 1);
  for (std::size_t a = 0; a + ends_on_wall < columns.size(); ++a)
    loop.push_back(node_point(columns[a][n], -1));
  if (ends_free(c, 1))
    for (std::size_t i = n - 1; i > 0; --i) loop.push_back(node_point(columns.back()[i], -1));
}

/// All but the last point.
void LayerBuilder::add_wall_points(int w, bool with_layers, std::vector<LoopPoint>& loop) const {
  const WallNodes& wall = walls_[w];
  const int curve = layers_.found().walls[w].curve;
  const auto& [first, last] = wall.sides;
  for (std::size_t i = with_layers || !first.is_front ? 0 : first.nodes.size() - 1; i < first.nodes.size();
       ++i)
    loop.push_back(node_point(first.nodes[i], curve));
  for (const int node : wall.nodes) loop.push_back(node_point(node, curve));
  if (with_layers || !last.is_front)
    for (std::size_t i = last.nodes.size() - 1; i > 0; --i) loop.push_back(node_point(last.nodes[i], curve));
}

void LayerBuilder::replace_lines(std::map<std::pair<int, int>, std::vector<int>>& replaced) const {
  for (std::size_t w = 0; w < walls_.size(); ++w) {
    const std::vector<int>& points = layers_.found().walls[w].points;
    std::vector<LoopPoint> loop;
    add_wall_points(static_cast<int>(w), true, loop);
    std::vector<int> nodes;
    for (const LoopPoint& p : loop) nodes.push_back(p.node);
    nodes.push_back(patch_.point_node[points.back()]);
    for (std::size_t i = 0; i + 1 < points.size(); ++i)
      replaced[{patch_.point_node[points[i]], patch_.point_node[points[i + 1]]}] =
          std::exchange(nodes, std::vector<int>());
  }
}

}  // namespace delquad
