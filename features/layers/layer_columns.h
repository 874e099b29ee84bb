// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <span>
#include <vector>

#include "features/layers/layer_chains.h"

// This header has the columns of nodes of layers. Heights are lengths in space, directions are of the plane
// of the patch. Features use it.

namespace delquad {

/// Nodes above a point of a chain, one for each layer.
struct LayerColumn {
  int at;            ///< index of the point in its chain
  int point;         ///< of the patch
  Vec2 direction;    ///< from a node at height h to the point: h * stretch * direction; not of unit length
  int wall = -1;     ///< wall that the nodes lie on, instead of along the direction
  int end = 0;       ///< of the wall
  double slant = 1;  ///< length along the wall over height
};

/// A node of a chain's columns; layer 0 is the point below.
struct ColumnNode {
  int column, layer;
};

/// Shape of a chain at one of its points.
struct ChainCorner {
  enum Kind { kSmooth, kMitre, kFan, kOnWall, kFanToWall, kOpenEnd };
  Kind kind = kSmooth;
  double angle = 0;  ///< inside of the boundary, radians
  Vec2 in, out;      ///< unit tangents of the edges before and after; at an end both belong to its edge
  int quads = 0;     ///< number of quads of a fan in the first layer
};

/// The columns of all chains of a patch, for given scales of their heights. c is a chain, k a point of it.
class LayerColumns {
 public:
  LayerColumns(const PlanarDomain& domain, int patch, const LayerChains& found,
               std::span<const LayerSpec> specs, const std::vector<std::vector<double>>& heights);

  int n_chains() const { return static_cast<int>(found_.chains.size()); }
  const LayerChains& found() const { return found_; }
  const LayerChain& chain(int c) const { return found_.chains[c]; }
  const ChainCorner& corner(int c, int k) const { return corners_[c][k]; }
  /// Returns the number of layers on the edge from a point, and at a point: the larger of its two edges.
  int layers_on(int c, int k) const { return n_of(chain(c).spec[k]); }
  int layers_at(int c, int k) const;
  /// Returns the number of layers between two neighboring columns.
  int layers_between(int c, int a, int b) const;
  /// Returns the place of a point, and its node.
  Vec2 foot(int c, int k) const { return patch_.points[chain(c).points[k]]; }
  int foot_node(int c, int k) const { return patch_.point_node[chain(c).points[k]]; }
  /// Returns the distance of two points in space.
  double distance(int c, int k, int l) const {
    return norm(domain_.boundary.points[foot_node(c, l)] - domain_.boundary.points[foot_node(c, k)]);
  }
  /// Returns the length in the patch's plane over the length in space, inwards from a point.
  double stretch(int c, int k) const { return stretches_[c][k]; }
  /// Returns the lengths in space of the edges at a point; at an end both belong to its edge.
  std::array<double, 2> edges_at(int c, int k) const;

  /// Factors of the heights at each point of each chain, from 0 to 1.
  std::vector<std::vector<double>> scales;
  /// Returns the height of a node above a point.
  double height(int c, int k, int layer) const;
  double thickness(int c, int k) const { return height(c, k, layers_at(c, k)); }

  /// Returns a wall of found(), on which layers of other patches may end.
  LayerWall& wall(int w) { return found_.walls[w]; }
  /// Returns the length along the wall over height, at an end of an open chain.
  double slant(int c, int end) const { return slants_[c][end]; }
  /// Gives an end the mean of the heights of its own layer and the `others`, and this slant.
  void join_end(int c, int end, std::vector<int> others, double slant);
  /// Places the columns again; call it after scales have changed.
  void place();
  const std::vector<LayerColumn>& columns(int c) const { return columns_[c]; }
  Vec2 point(int c, const LayerColumn& column, double height) const;
  Vec2 node(int c, ColumnNode node) const {
    const LayerColumn& column = columns_[c][node.column];
    return point(c, column, height(c, column.at, node.layer));
  }

  /// Calls visit(a, b) for columns side by side, in the order of the chain.
  template <class Visit>
  void for_each_pair(int c, Visit visit) const {
    const int n = static_cast<int>(columns_[c].size());
    for (int a = 0; a + 1 < n; ++a) visit(a, a + 1);
    if (chain(c).is_closed) visit(n - 1, 0);
  }
  /// Calls visit(array of four ColumnNode), counterclockwise, layer by layer of each pair of columns. At the
  /// corner of a fan the first layer has quads of three columns each.
  template <class Visit>
  void for_each_quad(int c, Visit visit) const {
    for_each_pair(c, [&](int a, int b) {
      const bool in_fan = columns_[c][a].point == columns_[c][b].point;
      for (int i = in_fan ? 2 : 1, n = layers_between(c, a, b); i <= n; ++i)
        visit(std::array<ColumnNode, 4>{{{a, i - 1}, {b, i - 1}, {b, i}, {a, i}}});
    });
    const int n = static_cast<int>(columns_[c].size());
    for (int first = 0; first < n;) {
      int last = first;
      while (last + 1 < n && columns_[c][last + 1].point == columns_[c][first].point) ++last;
      for (int a = first; a < last; a += 2)
        visit(std::array<ColumnNode, 4>{{{a, 0}, {a + 2, 1}, {a + 1, 1}, {a, 1}}});
      first = last + 1;
    }
  }

 private:
  void set_corner(int c, int k, std::span<const LayerSpec> specs);
  int n_of(int spec) const { return static_cast<int>(heights_[spec].size()); }
  void set_end(ChainCorner& corner, int c, int end);
  int fan_quads(double turn, int c, int k) const;
  void add_columns(int c, int k, double lean);
  void add_fan_to_wall(int c, int k);
  std::vector<double> leans(int c) const;
  void lean_beside(int c, int k, bool forward, std::vector<double>& leans) const;
  double lean_of(int c, int k, bool forward) const;
  LayerColumn on_wall(int c, int k) const;

  double stretch_at(int c, int k) const;

  const PlanarDomain& domain_;
  const int index_;
  const PatchBoundary& patch_;
  LayerChains found_;
  const std::vector<std::vector<double>>& heights_;
  std::vector<std::vector<ChainCorner>> corners_;
  std::vector<std::vector<double>> stretches_;
  std::vector<std::array<double, 2>> slants_;            ///< of chains' ends
  std::vector<std::array<std::vector<int>, 2>> joined_;  ///< layers of others that share the end
  std::vector<std::vector<LayerColumn>> columns_;
};

/// Scales heights down until no quad is inverted and no front edge is much shorter than the edge of the curve
/// below. Fronts then also keep a distance from each other and from the boundary: at most half their
/// thickness, or an edge. Scales change smoothly along a chain. `again` tells that they were fitted before
/// and some ends are lower now, which may suffice. Throws InputError, with curve and place, if no scale
/// helps. Own method.
void fit_layers(const PlanarDomain& domain, int patch, std::span<const LayerSpec> specs, LayerColumns& layers,
                bool again = false);

}  // namespace delquad
