// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <vector>

#include "geometry/mesh/nearest_triangle.h"

// This header finds nearest points on regions. Washers, curved elements and the pipeline use it.

namespace delquad {

/// Finds nearest points on the triangles of each region of a mesh.
class NearestOnRegions {
 public:
  explicit NearestOnRegions(const Mesh& mesh);
  /// Returns the point of a region (index) nearest to x; x if the region has no triangles.
  Vec3 place(int region, const Vec3& x) const;

 private:
  std::vector<std::vector<Vec3>> points_;                    ///< of each region
  std::vector<std::unique_ptr<NearestTriangle>> triangles_;  ///< null: none
};

}  // namespace delquad
