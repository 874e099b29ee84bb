// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "base/box_tree.h"
#include "delquad/mesh.h"
#include "geometry/mesh/nearest_triangle.h"

// This header has the closed skin of a body. Volume meshing asks it for inside and distance.

namespace delquad {

/// A closed surface of quads, counterclockwise seen from outside; each quad is two triangles.
class Skin {
 public:
  /// Throws std::invalid_argument without quads.
  explicit Skin(const Mesh& body);

  /// The body with the quads, whose points are corners of these.
  const Mesh& body() const { return body_; }

  /// Returns whether x lies inside: whether a ray from x crosses the skin an odd number of times.
  bool contains(const Vec3& x) const;
  /// Returns the distance from x to the skin if it is within `reach`, otherwise infinity.
  double distance(const Vec3& x, double reach) const { return nearest_.find(x, reach).distance; }

 private:
  const Mesh& body_;
  std::vector<std::array<Vec3, 3>> corners_;
  NearestTriangle nearest_;
  BoxTree<Vec3> tree_;
};

}  // namespace delquad
