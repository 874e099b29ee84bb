#pragma once

#include <map>
#include <utility>
#include <vector>

#include "geometry/planar/layers/layer_columns.h"

namespace delquad {

/// Puts the layers of one patch into its domain: nodes and quads at once, boundaries and lines when asked.
class LayerBuilder {
 public:
  LayerBuilder(PlanarDomain& domain, std::size_t patch, const LayerColumns& layers);

  /// The patch with its layers, walls with their new nodes.
  PatchBoundary outline() const { return boundary(true); }
  /// What is left of it.
  PatchBoundary rest() const { return boundary(false); }
  /// Nodes of walls in the place of a line of theirs; none in the place of the others. Lines by their nodes.
  void replace_lines(std::map<std::pair<int, int>, std::vector<int>>& replaced) const;

 private:
  /// A point of a loop, and the curve of the edge from it.
  struct LoopPoint {
    Vec2 at;
    int node, curve;
  };
  /// Layers at an end of a wall.
  struct WallSide {
    std::vector<int> nodes;  ///< from the end on
    double along = 0;        ///< length up to the last
    bool is_front = false;   ///< the front begins at the last; else the wall is free from its end on
  };
  struct WallNodes {
    std::array<WallSide, 2> sides;
    double from = 0, to = 0;      ///< places of what is between
    int n = 1;                    ///< edges there
    std::vector<int> nodes = {};  ///< inside of that
  };

  int add_node(Vec2 at);
  void add_columns(int c);
  void add_wall(int w);
  WallSide wall_side(int w, int end);
  bool ends_free(int c, int end) const;
  void make_even();
  void place_wall(int w);
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
  std::vector<int> curve_;                              ///< of the edge from each point
  std::vector<std::vector<std::vector<int>>> columns_;  ///< nodes, by chain and column, from the foot up
  std::vector<WallNodes> walls_;
};

}  // namespace delquad
