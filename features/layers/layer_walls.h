// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "features/layers/layer_columns.h"

// This header makes layers of adjacent patches fit. Features use it.

namespace delquad {

/// The layers of one patch, and its walls that layers of others end on.
struct PatchLayers {
  int patch;
  LayerColumns columns;
};

/// Returns the layers of all patches that have some, or walls at which other layers end, in the patches'
/// order; none of mirror images. Throws InputError as find_layer_chains(), and where layers end on a curve
/// that has layers on its other side.
std::vector<PatchLayers> find_patch_layers(const PlanarDomain& domain, std::span<const LayerSpec> specs,
                                           const CurveLayers& layers, const BoundaryGraph& graph,
                                           const std::vector<std::vector<double>>& heights);

/// The nodes on a wall as they were, and the new ones with their places: see WallTrack::place().
struct WallNodes {
  std::vector<int> old;
  std::map<int, double> places;
};

/// Adds a node that stays where it is; returns its number.
int add_node(PlanarDomain& domain, Vec2 at);
int add_node(PlanarDomain& domain, const Vec3& at);

/// The walls of all patches, each once, however many patches have it.
class LayerWalls {
 public:
  /// Tells walls apart, and makes the ends of layers alike that meet on one, or on periodic ones. Throws
  /// InputError where these differ in number, or a periodic wall has none.
  LayerWalls(PlanarDomain& domain, std::vector<PatchLayers>& patches, std::span<const LayerSpec> specs);

  /// Gives ends that are alike the least of their scales. Returns the patches of which some became less.
  std::vector<std::size_t> lower_shared_scales();
  /// Numbers of edges, and even ones around each patch. To be called once the layers are fitted. Throws
  /// InputError where that cannot be.
  void count_edges();

  /// Returns the nodes of a wall, as its patch sees it: from an end up to the height of the layers there, and
  /// between these. Made when they are asked for first.
  std::vector<int> side(const LayerWall& wall, int end);
  std::vector<int> between(const LayerWall& wall);
  /// Where a node of side() or between() is, as the patch of the wall sees it.
  double place(const LayerWall& wall, int node) const;
  /// Returns the nodes of each wall on a surface.
  std::vector<WallNodes> nodes() const;
  /// Adds the new pairs of nodes to the periodic curves.
  void pair_nodes();

 private:
  /// An end of a chain.
  struct ChainEnd {
    std::size_t patch;  ///< index into patches_
    int chain, end;
  };
  struct Wall {
    std::size_t patch;                                 ///< the first that has it
    int index;                                         ///< of the wall there
    std::vector<std::pair<std::size_t, int>> seen_by;  ///< all that have it, and as which wall of theirs
    std::array<std::vector<ChainEnd>, 2> ends = {};    ///< of layers, at its first and last point
    std::array<int, 2> group = {-1, -1};
    int master = -1;   ///< whose image it is; -1: none
    int pairing = -1;  ///< of the mesh, by which it is that
    bool runs_as_master = true;
    bool is_paired = false;                         ///< it is an image, or has one
    std::array<std::vector<double>, 2> along = {};  ///< of the nodes at the ends: how far they are from these
    double from = 0, to = 0;                        ///< places of what is between
    int n = 1;                                      ///< edges there
    std::array<std::vector<int>, 2> sides = {};
    std::vector<int> nodes = {};
    bool has_nodes = false;
    std::map<int, double> places = {};  ///< of its nodes
  };

  const LayerWall& shape_of(const Wall& wall) const {
    return patches_[wall.patch].columns.found().walls[wall.index];
  }
  const LayerColumns& columns(const ChainEnd& e) const { return patches_[e.patch].columns; }
  int point_of(const ChainEnd& e) const { return e.end == 0 ? 0 : columns(e).chain(e.chain).n_points() - 1; }
  int spec_of(const ChainEnd& e) const {
    const LayerChain& chain = columns(e).chain(e.chain);
    return e.end == 0 ? chain.spec.front() : chain.spec.back();
  }
  const ChainCorner& corner(const ChainEnd& e) const { return columns(e).corner(e.chain, point_of(e)); }
  void list_walls();
  void pair_walls();
  void pair_wall(int image, int pairing, const std::map<int, int>& master_of);
  void group_ends();
  void join(const std::vector<ChainEnd>& group);
  void mark_taken();
  void count(Wall& wall);
  bool make_even();
  std::vector<std::size_t> odd_patches() const;
  std::vector<std::vector<std::size_t>> patches_changed_by() const;
  const std::vector<int>& make_side(int id, int end);
  void make_between(int id);
  int add(Wall& wall, double place);

  PlanarDomain& domain_;
  std::vector<PatchLayers>& patches_;
  std::span<const LayerSpec> specs_;
  std::vector<Wall> walls_;
  std::vector<std::vector<ChainEnd>> groups_;  ///< of ends that are alike
};

}  // namespace delquad
