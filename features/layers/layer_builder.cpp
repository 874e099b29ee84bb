// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/layers/layer_builder.h"

#include <algorithm>
#include <array>

#include "geometry/patches/boundary_cap.h"

namespace delquad {

namespace {

/// A node as one side of a patch sees it.
struct PatchNode {
  int node;
  Vec2 u;
};

/// Nodes at an end of a wall, from there on.
struct WallSide {
  std::vector<PatchNode> nodes;
  bool is_front = false;  ///< the front begins at the last; else the wall is free from its end on
};

struct WallParts {
  std::array<WallSide, 2> sides;
  std::vector<PatchNode> between = {};
};

class LayerBuilder {
 public:
  LayerBuilder(PlanarDomain& domain, const PatchLayers& layers, LayerWalls& walls)
      : domain_(domain),
        index_(layers.patch),
        patch_(domain.patches[layers.patch]),
        layers_(layers.columns),
        all_walls_(walls),
        curve_(patch_.points.size()),
        columns_(layers.columns.n_chains()) {
    for (std::size_t e = 0; e < patch_.edges.size(); ++e) curve_[patch_.edges[e][0]] = patch_.edge_curve[e];
    for (int c = 0; c < layers_.n_chains(); ++c) add_columns(c);
    const std::vector<LayerWall>& found = layers_.found().walls;
    for (const LayerWall& wall : found) walls_.push_back({{wall_side(wall, 0), wall_side(wall, 1)}});
    for (std::size_t w = 0; w < walls_.size(); ++w)
      walls_[w].between = on_wall(found[w], walls.between(found[w]));
    for (int c = 0; c < layers_.n_chains(); ++c) add_quads(c, domain.patch_region[layers.patch]);
  }

  PatchBoundary boundary(bool with_layers) const {
    std::vector<int> chain_at(patch_.points.size(), -1), wall_at = chain_at;
    const LayerChains& found = layers_.found();
    for (std::size_t c = 0; c < found.chains.size(); ++c)
      chain_at[found.chains[c].points[0]] = static_cast<int>(c);
    for (std::size_t w = 0; w < found.walls.size(); ++w)
      wall_at[found.walls[w].points[0]] = static_cast<int>(w);
    std::vector<BoundaryLoop> result;
    for (const std::vector<int>& starts : loops()) {
      BoundaryLoop& loop = result.emplace_back();
      for (const int p : starts)
        if (chain_at[p] >= 0)
          add_chain(chain_at[p], with_layers, loop);
        else if (wall_at[p] >= 0)
          add_wall_points(wall_at[p], with_layers, loop);
        else
          loop.push_back(patch_point(p));
    }
    return make_boundary(result);
  }

  std::vector<std::pair<std::vector<int>, std::vector<int>>> replaced_walls() const {
    std::vector<std::pair<std::vector<int>, std::vector<int>>> replaced;
    for (std::size_t w = 0; w < walls_.size(); ++w) {
      auto& [old, nodes] = replaced.emplace_back();
      for (const int p : layers_.found().walls[w].points) old.push_back(patch_.point_node[p]);
      BoundaryLoop loop;
      add_wall_points(static_cast<int>(w), true, loop);
      for (const LoopPoint& p : loop) nodes.push_back(p.node);
      nodes.push_back(old.back());
    }
    return replaced;
  }

 private:
  void add_columns(int c) {
    const auto& columns = layers_.columns(c);
    for (int a = 0; a < static_cast<int>(columns.size()); ++a) {
      const int foot = patch_.point_node[columns[a].point];
      if (!domain_.places.empty()) domain_.places[foot] = {};
      if (columns[a].wall >= 0) {
        columns_[c].push_back(wall_side(layers_.found().walls[columns[a].wall], 1 - columns[a].end).nodes);
        continue;
      }
      std::vector<PatchNode> nodes = {{foot, patch_.points[columns[a].point]}};
      for (int i = 1; i <= layers_.layers_at(c, columns[a].at); ++i) {
        const Vec2 u = layers_.node(c, {a, i});
        nodes.push_back(domain_.in_space != nullptr ? above(c, {a, i}, nodes.back())
                                                    : PatchNode{add_node(domain_, u), u});
      }
      columns_[c].push_back(std::move(nodes));
    }
  }

  /// Adds a node of a column above the last one.
  PatchNode above(int c, ColumnNode node, const PatchNode& last) {
    const LayerColumn& column = layers_.columns(c)[node.column];
    const auto height = [&](int layer) { return layers_.height(c, column.at, layer); };
    const double rise = height(node.layer) - height(node.layer - 1);
    const PatchPlace place = domain_.in_space->next(index_, {last.u, domain_.boundary.points[last.node]},
                                                    rise * layers_.stretch(c, column.at) * column.direction,
                                                    rise * norm(column.direction));
    return {add_node(domain_, place.x), place.u};
  }

  std::vector<PatchNode> on_wall(const LayerWall& wall, const std::vector<int>& nodes) const {
    std::vector<PatchNode> result;
    for (const int node : nodes) {
      const Vec3& p = domain_.boundary.points[node];
      result.push_back({node, domain_.in_space != nullptr ? wall.track.point(all_walls_.place(wall, node))
                                                          : Vec2{p.x, p.y}});
    }
    return result;
  }

  bool ends_free(int c, int end) const {
    const LayerChain& chain = layers_.chain(c);
    return !chain.is_closed &&
           layers_.corner(c, end == 0 ? 0 : chain.n_points() - 1).kind == ChainCorner::kOpenEnd;
  }

  /// Beside a free end of layers a wall has as many nodes, as far apart.
  WallSide wall_side(const LayerWall& wall, int end) {
    const int c = wall.chain[end];
    // The wall begins where the chain ends.
    return {on_wall(wall, all_walls_.side(wall, end)), c >= 0 && !ends_free(c, 1 - end)};
  }

  void add_quads(int c, int region) {
    layers_.for_each_quad(c, [&](const std::array<ColumnNode, 4>& quad) {
      std::array<int, 4> nodes;
      for (int i = 0; i < 4; ++i) nodes[i] = columns_[c][quad[i].column][quad[i].layer].node;
      domain_.boundary.quads.push_back(nodes);
      domain_.boundary.quad_region.push_back(region);
    });
  }

  /// Each begins at a point where a chain or wall does, or none of them is.
  std::vector<std::vector<int>> loops() const {
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

  LoopPoint patch_point(int p) const { return {patch_.points[p], patch_.point_node[p], curve_[p]}; }

  /// All but the last point of a chain that is open.
  void add_chain(int c, bool with_layers, BoundaryLoop& loop) const {
    if (!with_layers) return add_front(c, loop);
    const LayerChain& chain = layers_.chain(c);
    for (int k = 0; k + (chain.is_closed ? 0 : 1) < chain.n_points(); ++k)
      loop.push_back(patch_point(chain.points[k]));
  }

  /// Along the tops of the columns, and along their sides where numbers of layers change.
  void add_front(int c, BoundaryLoop& loop) const {
    const auto& columns = columns_[c];
    const LayerChain& chain = layers_.chain(c);
    std::vector<int> levels;  // of the pair from each column
    layers_.for_each_pair(c, [&](int a, int b) { levels.push_back(layers_.layers_between(c, a, b)); });
    // From `from` on to `to`, without it.
    const auto add = [&](const std::vector<PatchNode>& column, int i) {
      const auto& [node, u] = column[static_cast<std::size_t>(i)];
      loop.push_back({u, node, -1});
    };
    const auto climb = [&](const std::vector<PatchNode>& column, int from, int to) {
      for (int i = from; i != to; i += from < to ? 1 : -1) add(column, i);
    };
    if (ends_free(c, 0)) climb(columns.front(), 0, levels.front());
    int last = chain.is_closed ? levels.back() : levels.front();
    for (std::size_t a = 0; a < levels.size(); ++a) {
      climb(columns[a], last, levels[a]);
      last = levels[a];
      add(columns[a], last);
    }
    if (ends_free(c, 1)) climb(columns.back(), last, 0);
  }

  /// All but the last point.
  void add_wall_points(int w, bool with_layers, BoundaryLoop& loop) const {
    const WallParts& wall = walls_[w];
    const int curve = layers_.found().walls[w].curve;
    const auto& [first, last] = wall.sides;
    const auto add = [&](const PatchNode& p) { loop.push_back({p.u, p.node, curve}); };
    std::for_each(first.nodes.begin() + (with_layers || !first.is_front ? 0 : std::ssize(first.nodes) - 1),
                  first.nodes.end(), add);
    std::ranges::for_each(wall.between, add);
    if (with_layers || !last.is_front) std::for_each(last.nodes.rbegin(), last.nodes.rend() - 1, add);
  }

  PlanarDomain& domain_;
  const int index_;
  const PatchBoundary& patch_;
  const LayerColumns& layers_;
  LayerWalls& all_walls_;
  std::vector<int> curve_;                                    ///< of the edge from each point
  std::vector<std::vector<std::vector<PatchNode>>> columns_;  ///< by chain and column, from the foot up
  std::vector<WallParts> walls_;
};

}  // namespace

LayeredPatch build_layers(PlanarDomain& domain, const PatchLayers& layers, LayerWalls& walls) {
  const std::size_t first = domain.boundary.quads.size();
  const LayerBuilder builder(domain, layers, walls);
  return {builder.boundary(true),
          builder.boundary(false),
          builder.replaced_walls(),
          {first, domain.boundary.quads.size()}};
}

}  // namespace delquad
