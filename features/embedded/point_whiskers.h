#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "base/box_tree.h"
#include "delquad/mesh.h"

namespace delquad {

/// Where the two edges at a point that stands alone on a surface may end.
class PointWhiskers {
 public:
  /// Whiskers keep away from the lines that the mesh has now and from the other points (indices into it).
  PointWhiskers(const Mesh& mesh, const std::vector<int>& points);

  /// Ends of edges from the point about as long as `size`, shorter where anything is near; none where there
  /// is no room for a thousandth of it. `normal` at the point: any length; `onto`: the nearest place of the
  /// surface.
  std::optional<std::array<Vec3, 2>> ends(std::size_t point, const Vec3& normal, double size,
                                          const std::function<Vec3(const Vec3&)>& onto);

 private:
  using Segment = std::array<Vec3, 2>;
  bool has_room(std::size_t point, const std::array<Vec3, 2>& ends) const;
  double distance(std::size_t point, const Vec3& x) const;

  std::vector<Segment> segments_;  ///< lines, then points
  std::size_t first_point_;
  BoxTree<Vec3> tree_;
  std::vector<Segment> taken_;
};

}  // namespace delquad
