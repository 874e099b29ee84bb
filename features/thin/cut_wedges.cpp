// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/thin/cut_wedges.h"

#include <utility>
#include <vector>

#include "geometry/patches/boundary_cap.h"

namespace delquad {

void cut_wedges(PlanarDomain& domain) {
  /// In sizes: behind it a single row lies between nodes that face each other.
  constexpr double kWidestWedge = 0.5;
  Mesh& mesh = domain.boundary;
  std::vector<char> stays(domain.patches.size(), 0);
  for (const MappedPatch& grid : domain.mapped) stays[grid.patch] = 1;
  const CapNodes nodes{[](int) { return true; },
                       [&](int v) { return mesh.points[v]; },
                       [](const Vec3& x, Vec2) { return x; },
                       [](Vec2) {
                         return Vec3{0, 0, 1};
                       },
                       [&](const Vec3& x) {
                         mesh.points.push_back(x);
                         domain.places.emplace_back();
                         return static_cast<int>(mesh.points.size()) - 1;
                       },
                       kWidestWedge,
                       false};
  std::vector<PatchBoundary> outlines = domain.patches;
  for (std::size_t p = 0; p < domain.patches.size(); ++p) {
    if (stays[p]) continue;
    PatchBoundary& patch = domain.patches[p];
    for (const BoundaryCap& cap : cap_corners(patch, nodes))
      for (const auto& quad : cap.quads) {
        mesh.quads.push_back(quad);
        mesh.quad_region.push_back(domain.patch_region[p]);
        for (const int v : quad) domain.places[v] = {};
      }
    for (std::size_t i = 0; i < patch.points.size(); ++i) {
      const Vec3& x = mesh.points[patch.point_node[i]];
      patch.points[i] = {x.x, x.y};
    }
  }
  if (!mesh.quads.empty()) domain.outlines = std::move(outlines);
}

}  // namespace delquad
