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

/// The layers of one patch, and its walls on which layers of others end.
struct PatchLayers {
  int patch;
  LayerColumns columns;
};

/// Returns the layers of all patches that have some, or walls at which other layers end, in the order of
/// patches. Throws InputError as find_layer_chains(), and if layers end on a curve
/// that has layers on its other side.
std::vector<PatchLayers> find_patch_layers(const PlanarDomain& domain, std::span<const LayerSpec> specs,
                                           const CurveLayers& layers, const BoundaryGraph& graph,
                                           const std::vector<std::vector<double>>& heights);

/// The old nodes on a wall, and the new ones with their places, see WallTrack.
struct WallNodes {
  std::vector<int> old;
  std::map<int, double> places;
};

/// Adds a node that no stage moves, and returns its number.
int add_node(PlanarDomain& domain, Vec2 at);
int add_node(PlanarDomain& domain, const Vec3& at);

/// The walls of all patches; each is stored once, and several patches may have it.
class LayerWalls {
 public:
  /// Finds equal walls, and makes ends of layers alike that meet on one wall, or on periodic walls. Throws
  /// InputError if their numbers differ, or if a periodic wall has none.
  LayerWalls(PlanarDomain& domain, std::vector<PatchLayers>& patches, std::span<const LayerSpec> specs);

  /// Gives ends that are alike the least of their scales. Returns the patches with a smaller scale.
  std::vector<std::size_t> lower_shared_scales();
  /// Chooses numbers of edges, even around each patch. Call it after the layers are fitted. Throws InputError
  /// if that is impossible.
  void count_edges();

  /// Returns the nodes of a wall in the order of its patch: from an end up to the height of the layers there.
  /// The first call makes them.
  std::vector<int> side(const LayerWall& wall, int end);
  /// Returns the nodes between both ends.
  std::vector<int> between(const LayerWall& wall);
  /// Returns the place of a node of side() or between(), as the patch of the wall sees it.
  double place(const LayerWall& wall, int node) const;
  /// Returns the nodes of each wall on a surface.
  std::vector<WallNodes> nodes() const;
  /// Adds the new pairs of nodes to the periodic curves.
  void pair_nodes();

 private:
  /// An end of a chain of layers.
  struct ChainEnd {
    std::size_t patch;  ///< index into patches_
    int chain, end;
  };
  struct Wall {
    std::size_t patch;  ///< the first that has it
    int index;          ///< index of the wall there
    std::vector<std::pair<std::size_t, int>>
        seen_by;  ///< all patches that have it, with the index of the wall there
    std::array<std::vector<ChainEnd>, 2> ends = {};  ///< of layers, at its first and last point
    std::array<int, 2> group = {-1, -1};
    int master = -1;   ///< wall whose image it is; -1: none
    int pairing = -1;  ///< index of the periodic pair of the mesh
    bool runs_as_master = true;
    bool is_paired = false;                         ///< it is an image, or has one
    std::array<std::vector<double>, 2> along = {};  ///< lengths from each end to its nodes
    double from = 0, to = 0;                        ///< places between which nodes are free
    int n = 1;                                      ///< number of edges there
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
  int add_image(Wall& wall, int master);

  PlanarDomain& domain_;
  std::vector<PatchLayers>& patches_;
  std::span<const LayerSpec> specs_;
  std::vector<Wall> walls_;
  std::vector<std::vector<ChainEnd>> groups_;  ///< of ends that are alike
};

}  // namespace delquad
