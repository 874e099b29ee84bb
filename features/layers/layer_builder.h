#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <utility>
#include <vector>

#include "features/layers/layer_columns.h"
#include "features/layers/layer_walls.h"

namespace delquad {

/// Puts the layers of one patch into its domain: nodes and quads at once, boundaries and lines when asked.
class LayerBuilder {
 public:
  LayerBuilder(PlanarDomain& domain, const PatchLayers& layers, LayerWalls& walls);

  /// The patch with its layers, walls with their new nodes.
  PatchBoundary outline() const { return boundary(true); }
  /// What is left of it.
  PatchBoundary rest() const { return boundary(false); }
  /// Nodes in the place of each wall; both by all of its nodes, in the order of the patch.
  std::vector<std::pair<std::vector<int>, std::vector<int>>> replaced_walls() const;
  /// Of the domain: the first of its quads, and the one after the last.
  std::pair<std::size_t, std::size_t> quads() const { return quads_; }

 private:
  /// A point of a loop, and the curve of the edge from it.
  struct LoopPoint {
    Vec2 at;
    int node, curve;
  };
  /// Nodes at an end of a wall, from there on.
  struct WallSide {
    std::vector<int> nodes;
    bool is_front = false;  ///< the front begins at the last; else the wall is free from its end on
  };
  struct WallNodes {
    std::array<WallSide, 2> sides;
    std::vector<int> between = {};
  };

  int add_node(Vec2 at);
  void add_columns(int c);
  bool ends_free(int c, int end) const;
  WallSide wall_side(const LayerWall& wall, int end);
  void add_quads(int c);

  PatchBoundary boundary(bool with_layers) const;
  std::vector<std::vector<int>> loops() const;
  LoopPoint node_point(int node, int curve) const;
  void add_chain(int c, bool with_layers, std::vector<LoopPoint>& loop) const;
  void add_front(int c, std::vector<LoopPoint>& loop) const;
  void add_wall_points(int w, bool with_layers, std::vector<LoopPoint>& loop) const;

  PlanarDomain& domain_;
  const PatchBoundary patch_;
  int region_;
  const LayerColumns& layers_;
  LayerWalls& all_walls_;
  std::vector<int> curve_;                              ///< of the edge from each point
  std::vector<std::vector<std::vector<int>>> columns_;  ///< nodes, by chain and column, from the foot up
  std::vector<WallNodes> walls_;
  std::pair<std::size_t, std::size_t> quads_;
};

}  // namespace delquad
