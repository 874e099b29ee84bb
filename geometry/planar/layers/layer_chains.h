#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "delquad/model.h"
#include "geometry/planar/layers/wall_track.h"
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
  int curve;                ///< of the mesh
  WallTrack track;
  std::array<int, 2> chain = {-1, -1};  ///< that ends at the first, and begins at the last point
};

struct LayerChains {
  std::vector<LayerChain> chains;
  std::vector<LayerWall> walls;
};

/// Which layer each curve of the boundary has; -1: none. Throws InputError for names that no curve has, for
/// curves with several layers, and for those that do not bound the domain.
std::vector<int> layers_of_curves(const PlanarDomain& domain, std::span<const LayerSpec> specs);

/// Of one patch. Throws InputError where other curves meet a layer, and where layers meet that have not the
/// same number. `heights`: see layer_heights(), by layer.
LayerChains find_layer_chains(const PlanarDomain& domain, std::size_t patch, std::span<const LayerSpec> specs,
                              const std::vector<int>& of_curve,
                              const std::vector<std::vector<double>>& heights);

/// Points at which the boundary turns by more than this are corners, radians.
inline constexpr double kLayerCorner = 20 * 0.017453292519943295;

/// The angle inside of the boundary at a point, in (0, 2 pi).
double inner_angle(Vec2 before, Vec2 at, Vec2 after);

}  // namespace delquad
