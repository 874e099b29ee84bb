// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/box_tree.h"
#include "delquad/fields.h"
#include "delquad/mesh.h"

// This header makes nodes of points that stand alone. Imprinted points and planar models use it.

namespace delquad {

/// Where the two edges at a point that stands alone may end.
class DanglingEdges {
 public:
  /// Dangling curves keep away from the lines that the mesh has now and from the other points (indices into
  /// it).
  DanglingEdges(const Mesh& mesh, const std::vector<int>& points);

  /// Returns ends of edges from the point about as long as `size`, shorter where anything is near. None if
  /// there is no room for a thousandth of it. `normal` at the point: any length; `onto`: the nearest place of
  /// the surface. Own method.
  std::optional<std::array<Vec3, 2>> ends(std::size_t point, const Vec3& normal, double size,
                                          const std::function<Vec3(const Vec3&)>& onto);

 private:
  using Segment = std::array<Vec3, 2>;

  bool is_clear(std::size_t point, const std::array<Vec3, 2>& ends) const;
  double distance(std::size_t point, const Vec3& x) const;

  std::vector<Segment> segments_;  ///< lines, then points
  std::size_t first_point_;
  BoxTree<Vec3> tree_;
  std::vector<Segment> taken_;
};

/// Returns why a point at a place has no edges, after its label.
std::string no_room_for_edges(double size, const std::string& place);

/// Returns the ends for each of these points of a plane, by the lines of a mesh. Throws InputError, with the
/// label of the point, if there is no room.
std::vector<std::array<Vec3, 2>> dangling_ends(const Mesh& lines, const std::vector<int>& points,
                                               const SizeField& size,
                                               const std::function<std::string(std::size_t)>& label);

}  // namespace delquad
