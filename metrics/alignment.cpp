// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrics/alignment.h"

#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include "base/parallel.h"

namespace delquad {

double mean_misalignment(const Mesh& mesh, std::span<const HalfEdge> sides, const CrossInSpace& cross_at) {
  const int n_triangles = static_cast<int>(mesh.triangles.size());
  std::vector<std::array<int, 2>> edges;
  for_each_edge(sides, [&](std::span<const HalfEdge> edge) {
    if (edge.size() == 2 && edge[0].element >= n_triangles && edge[1].element >= n_triangles)
      edges.push_back({edge[0].lo, edge[0].hi});
  });
  std::vector<double> angles(edges.size(), std::nan(""));
  parallel_ranges(edges.size(), [&](std::size_t begin, std::size_t end) {
    int hint = -1;
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3 &a = mesh.points[edges[i][0]], &b = mesh.points[edges[i][1]], way = b - a;
      const auto directions = cross_at(0.5 * (a + b), norm(way), hint);
      if (!directions) continue;
      for (const Vec3& d : *directions)
        angles[i] = std::fmin(angles[i], std::atan2(norm(cross(d, way)), std::abs(dot(d, way))));
    }
  });
  std::erase_if(angles, [](double angle) { return std::isnan(angle); });
  return std::accumulate(angles.begin(), angles.end(), 0.0) / static_cast<double>(angles.size()) * 180 /
         std::numbers::pi;
}

}  // namespace delquad
