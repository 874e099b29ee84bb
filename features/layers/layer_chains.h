#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "delquad/model.h"
#include "features/layers/boundary_graph.h"
#include "features/layers/curve_layers.h"
#include "features/layers/wall_track.h"
#include "geometry/planar/planar_model.h"

namespace delquad {

/// Edges of a patch's boundary, one after the other, that get layers.
struct LayerChain {
  std::vector<int> points;  ///< of the patch; of a closed chain the first is not repeated
  std::vector<int> spec;    ///< of the edge from each point; an open chain has one less than points
  bool is_closed = false;
  std::array<int, 2> wall = {-1, -1};  ///< at its first and last point; -1 where it is closed

  int n_points() const { return static_cast<int>(points.size()); }
  /// Of the edge before a point and that after it: -1: none.
  std::array<int, 2> specs_at(int k) const {
    const int n = n_points();
    return {k > 0 ? spec[k - 1] : is_closed ? spec[n - 1] : -1, k + 1 < n || is_closed ? spec[k] : -1};
  }
};

/// What lies beside a chain, up to the next corner.
struct LayerWall {
  std::vector<int> points;  ///< of the patch
  int curve;                ///< of the mesh; -1: an axis of symmetry
  WallTrack track;
  std::array<int, 2> chain = {-1, -1};  ///< that ends at the first, and begins at the last point
  bool is_axis = false;                 ///< a mirror image of the patch lies behind it
  /// Whether layers of some patch end at its first, at its last point.
  std::array<bool, 2> is_taken = {false, false};
  int id = -1;               ///< of the wall among those of all patches, see LayerWalls
  bool is_reversed = false;  ///< against that one

  /// How far nodes at the heights of layers may reach, from one end.
  double room() const { return (is_taken[0] && is_taken[1] ? 0.45 : 0.9) * track.length(); }
};

struct LayerChains {
  std::vector<LayerChain> chains;
  std::vector<LayerWall> walls;
};

/// Of one patch. Throws InputError where the boundary meets itself at a layer, or a crack does.
LayerChains find_layer_chains(const PlanarDomain& domain, std::size_t patch, std::span<const LayerSpec> specs,
                              const CurveLayers& layers, const BoundaryGraph& graph);

/// The wall along these points of a patch. Throws InputError where its number of edges was asked for.
LayerWall make_layer_wall(const PlanarDomain& domain, std::size_t patch, std::vector<int> points,
                          const BoundaryGraph& graph, const std::string& where);

}  // namespace delquad
