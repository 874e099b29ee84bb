// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrics/shape.h"

namespace delquad {

ElementSides::ElementSides(const Mesh& mesh) : mesh_(mesh) {
  for (const Vec3& p : mesh.points)
    if (p.z != mesh.points[0].z) return;
  int last = 0;
  for (const auto* regions : {&mesh.triangle_region, &mesh.quad_region})
    for (const int region : *regions) last = std::max(last, region);
  std::vector<double> area(static_cast<size_t>(last) + 1, 0);
  for (size_t t = 0; t < mesh.triangles.size(); ++t)
    area[index(mesh.triangle_region, static_cast<int>(t))] +=
        area_vector(corners_of(mesh, mesh.triangles[t])).z;
  for (size_t q = 0; q < mesh.quads.size(); ++q)
    area[index(mesh.quad_region, static_cast<int>(q))] += area_vector(corners_of(mesh, mesh.quads[q])).z;
  for (const double a : area) of_region_.push_back({0, 0, a < 0 ? -1.0 : 1.0});
}

}  // namespace delquad
