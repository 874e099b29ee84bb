#pragma once

#include <array>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "geometry/planar/planar_model.h"

namespace delquad {

/// The boundaries of all patches as one: what meets at a node, and which patch has an edge.
class BoundaryGraph {
 public:
  explicit BoundaryGraph(const PlanarDomain& domain);

  /// The patch on the left of the edge, and the edge's index there; images of other patches count, too.
  std::optional<std::array<int, 2>> edge_from(int a, int b) const;
  bool is_image(int patch) const { return is_image_[static_cast<std::size_t>(patch)] != 0; }
  /// Whether the edge lies between a patch and its mirror image.
  bool is_on_axis(int a, int b) const;
  /// Whether a piece of the boundary ends there: at corners of more than kLayerCorner, where curves meet or
  /// other curves follow, at named points and cracks, and where that is so at a periodic or mirror image.
  bool stops(int node) const { return stops_[static_cast<std::size_t>(node)] != 0; }
  bool is_on_crack(int node) const { return on_crack_[static_cast<std::size_t>(node)] != 0; }

 private:
  void find_stops(const PlanarDomain& domain);
  void share_stops(const PlanarDomain& domain);

  std::map<std::pair<int, int>, std::array<int, 2>> edges_;
  std::vector<char> is_image_, stops_, on_crack_;
};

/// Points at which the boundary turns by more than this are corners, radians.
inline constexpr double kLayerCorner = 20 * 0.017453292519943295;

/// The angle inside of the boundary at a point, in (0, 2 pi).
double inner_angle(Vec2 before, Vec2 at, Vec2 after);

}  // namespace delquad
