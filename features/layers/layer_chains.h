// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "delquad/model.h"
#include "features/layers/patch_places.h"
#include "geometry/planar/planar_model.h"

// This header finds the chains of edges on which layers stand. Features use it.

namespace delquad {

/// Layers of each curve of a domain.
struct CurveLayers {
  std::vector<std::vector<int>> of_curve;  ///< indices of layers
  std::vector<std::vector<char>> into;     ///< by layer and region, whether it goes there; empty: everywhere
  /// Returns the layer of a curve on the side of a region; -1: none.
  int at(int curve, int region) const;
};

/// Returns the layers of each curve. Throws InputError for names that no curve or region has, and for curves
/// with several layers on one side. Also throws for curves without a region, with the same region on both
/// sides, or with none of the named regions.
CurveLayers layers_of_curves(const PlanarDomain& domain, std::span<const LayerSpec> specs);

/// A chain of boundary edges between corners, on which nodes may be placed again. A place is the number of an
/// edge plus a share of it, from 0 to n_edges(). It lies on the curve of the chain, or on the edges if these
/// were given.
class WallTrack {
 public:
  /// `params` are the parameters of the points on the curve; a null curve stands for the edges.
  WallTrack(std::vector<Vec2> points, std::shared_ptr<const Curve> curve, std::vector<double> params);
  /// The track lies on the curve of a surface with these nodes.
  WallTrack(std::vector<Vec2> points, std::vector<int> nodes, const PatchPlaces& places, int patch);

  int n_edges() const { return static_cast<int>(points_.size()) - 1; }
  double length() const { return length_.back(); }
  /// Returns the place at a length from the first point, measured in space.
  double place(double length) const;
  Vec2 point(double place) const;
  /// Returns the point in space; z = 0 in planar domains.
  Vec3 spot(double place) const;
  /// Returns the parameter on the curve.
  double param(double place) const;
  const std::shared_ptr<const Curve>& curve() const { return curve_; }

 private:
  static constexpr int kSamples = 16;  // an edge

  void measure();
  std::pair<std::size_t, double> edge_at(double place) const;
  Vec2 straight(std::size_t edge, double part) const {
    return (1 - part) * points_[edge] + part * points_[edge + 1];
  }

  std::vector<Vec2> points_;
  std::shared_ptr<const Curve> curve_;
  std::vector<double> params_;
  std::vector<int> nodes_ = {};            ///< on a surface
  const PatchPlaces* in_space_ = nullptr;  ///< there
  int patch_ = -1;
  std::vector<double> length_ = {0};  ///< in space, up to each sample
};

/// The boundaries of all patches in one graph: the curves at each node, and the patch at each edge.
class BoundaryGraph {
 public:
  explicit BoundaryGraph(const PlanarDomain& domain);

  /// Returns the patch on the left of the edge from a to b, and the index of the edge there.
  std::optional<std::array<int, 2>> edge_from(int a, int b) const;
  /// Returns whether a piece of the boundary ends at a node. It ends at corners of more than kLayerCorner,
  /// where curves meet or change, and at named points and cracks. It also ends if one of these is true of a
  /// periodic image.
  bool stops(int node) const { return stops_[static_cast<std::size_t>(node)] != 0; }
  bool is_on_crack(int node) const { return on_crack_[static_cast<std::size_t>(node)] != 0; }
  /// Returns whether more than two patches meet at the edge.
  bool branches(int a, int b) const { return branching_.contains(std::minmax(a, b)); }

 private:
  void find_stops(const PlanarDomain& domain);
  void share_stops(const PlanarDomain& domain);

  std::map<std::pair<int, int>, std::array<int, 2>> edges_;
  std::set<std::pair<int, int>> branching_;
  std::vector<char> stops_, on_crack_;
};

/// The boundary has a corner at a point where it turns by more than this, in radians.
inline constexpr double kLayerCorner = 20 * 0.017453292519943295;

/// Returns the place of a node, for messages.
std::string show_node(const PlanarDomain& domain, int node);

/// Returns the angle inside of the boundary at a point, in (0, 2 pi).
double inner_angle(Vec2 before, Vec2 at, Vec2 after);

/// Consecutive edges of a patch boundary that get layers.
struct LayerChain {
  std::vector<int> points;  ///< of the patch; a closed chain does not repeat the first
  std::vector<int> spec;    ///< layer of the edge from each point; an open chain has one less than points
  bool is_closed = false;
  std::array<int, 2> wall = {-1, -1};  ///< walls at its first and last point; -1: it is closed

  int n_points() const { return static_cast<int>(points.size()); }
  /// Returns the specs of the edge before a point and of the edge after it; -1: none.
  std::array<int, 2> specs_at(int k) const {
    const int n = n_points();
    return {k > 0 ? spec[k - 1] : is_closed ? spec[n - 1] : -1, k + 1 < n || is_closed ? spec[k] : -1};
  }
};

/// The wall beside the end of a chain, up to the next corner: nodes at the heights of layers lie on it.
struct LayerWall {
  std::vector<int> points;  ///< of the patch
  int curve;                ///< index into Mesh::curves
  WallTrack track;
  std::array<int, 2> chain = {-1, -1};  ///< chains that end at its first point, and begin at its last one
  bool is_axis = false;                 ///< the mirror image of the patch lies behind it
  /// Whether layers of a patch end at its first and at its last point.
  std::array<bool, 2> is_taken = {false, false};
  int id = -1;               ///< number among the walls of all patches, see LayerWalls
  bool is_reversed = false;  ///< it runs against that wall

  /// Returns the length from an end within which nodes at the heights of layers may lie.
  double room() const { return (is_taken[0] && is_taken[1] ? 0.45 : 0.9) * track.length(); }
};

struct LayerChains {
  std::vector<LayerChain> chains;
  std::vector<LayerWall> walls;
};

/// Returns the chains of one patch. Throws InputError if the boundary or a crack meets itself at a layer.
LayerChains find_layer_chains(const PlanarDomain& domain, std::size_t patch, std::span<const LayerSpec> specs,
                              const CurveLayers& layers, const BoundaryGraph& graph);

/// Returns the wall along these points of a patch. Throws InputError, beginning with `where`, if its number
/// of edges is given.
LayerWall make_layer_wall(const PlanarDomain& domain, std::size_t patch, std::vector<int> points,
                          const BoundaryGraph& graph, const std::string& where);

}  // namespace delquad
