// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/mesh/nearest_on_regions.h"

#include <algorithm>
#include <utility>

#include "base/sort_unique.h"

namespace delquad {

NearestOnRegions::NearestOnRegions(const Mesh& mesh) : points_(mesh.regions.size()) {
  std::vector<std::vector<std::array<int, 3>>> triangles(mesh.regions.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    triangles[mesh.triangle_region[t]].push_back(mesh.triangles[t]);
  for (std::size_t r = 0; r < triangles.size(); ++r) {
    // With the region's points only.
    std::vector<int> used;
    for (const auto& v : triangles[r]) used.insert(used.end(), v.begin(), v.end());
    sort_unique(used);
    for (const int v : used) points_[r].push_back(mesh.points[v]);
    for (auto& triangle : triangles[r])
      for (int& v : triangle) v = static_cast<int>(std::ranges::lower_bound(used, v) - used.begin());
    triangles_.push_back(
        used.empty() ? nullptr : std::make_unique<NearestTriangle>(points_[r], std::move(triangles[r])));
  }
}

Vec3 NearestOnRegions::place(int region, const Vec3& x) const {
  const auto& nearest = triangles_[region];
  if (!nearest) return x;
  const NearestTriangle::Found found = nearest->find(x);
  const auto& [a, b, c] = nearest->triangle(found.triangle);
  const std::vector<Vec3>& p = points_[region];
  return found.weights[0] * p[a] + found.weights[1] * p[b] + found.weights[2] * p[c];
}

}  // namespace delquad
