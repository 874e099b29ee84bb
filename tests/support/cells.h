// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "geometry/mesh/cell_shapes.h"
#include "io/cell_view.h"

// This header makes meshes of cells of all shapes. Tests of measures, readers and writers use it.

namespace delquad::testing_support {

/// Adds the sides of one cell as faces of the mesh, by f(mesh, nodes), the index of a region.
template <class Region>
void add_skin(Mesh& mesh, const Region& region_of) {
  const std::vector<Entity> regions = mesh.regions;
  complete_faces(mesh, nullptr);
  mesh.regions = regions;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    mesh.triangle_region[i] = region_of(mesh, mesh.triangles[i]);
  for (std::size_t i = 0; i < mesh.quads.size(); ++i) mesh.quad_region[i] = region_of(mesh, mesh.quads[i]);
}

/// Three cubes with sides 1: a hexahedron, beside it five pyramids and two tetrahedra around a point, above
/// it two prisms. The skin has the regions "floor" (z = 0) and "rest", and triangles at x = 2. The prisms
/// are the volume "copper", the others are "steel". The pyramids can be left out.
inline Mesh mixed_solid(bool with_pyramids = true) {
  Mesh mesh;
  for (const double z : {0, 1, 2})
    for (const double y : {0, 1})
      for (const double x : {0, 1, 2}) mesh.points.push_back({x, y, z});
  const auto at = [](int x, int y, int z) { return x + 3 * y + 6 * z; };
  mesh.points.pop_back();  // (2, 1, 2), and below (2, 0, 2)
  mesh.points[at(2, 0, 2)] = {1.5, 0.5, 0.5};
  const int centre = at(2, 0, 2);
  mesh.hexahedra = {{at(0, 0, 0), at(1, 0, 0), at(1, 1, 0), at(0, 1, 0), at(0, 0, 1), at(1, 0, 1),
                     at(1, 1, 1), at(0, 1, 1)}};
  mesh.prisms = {{at(0, 0, 1), at(1, 0, 1), at(1, 0, 2), at(0, 1, 1), at(1, 1, 1), at(1, 1, 2)},
                 {at(0, 0, 1), at(1, 0, 2), at(0, 0, 2), at(0, 1, 1), at(1, 1, 2), at(0, 1, 2)}};
  for (auto& v : mesh.prisms) v = {v[0], v[2], v[1], v[3], v[5], v[4]};  // counterclockwise seen from y = 1
  const std::array<int, 8> cube = {at(1, 0, 0), at(2, 0, 0), at(2, 1, 0), at(1, 1, 0),
                                   at(1, 0, 1), at(2, 0, 1), at(2, 1, 1), at(1, 1, 1)};
  for (int s = 0; s < 6; ++s) {
    const auto [a, b, c, d] = Solid{kSolidShapes.data(), cube, 0}.side(s);
    if (s == 3) {  // x = 2
      mesh.tetrahedra.push_back({a, d, b, centre});
      mesh.tetrahedra.push_back({b, d, c, centre});
    } else if (with_pyramids) {
      mesh.pyramids.push_back({a, d, c, b, centre});
    }
  }
  mesh.hex_volume = {0};
  mesh.prism_volume = {1, 1};
  mesh.pyramid_volume.assign(mesh.pyramids.size(), 0);
  mesh.tet_volume.assign(2, 0);
  mesh.volumes = {{1, {"steel"}}, {2, {"copper"}}};
  mesh.regions = {{1, {"floor"}}, {2, {"rest"}}};
  add_skin(mesh, [](const Mesh& m, const auto& side) {
    return m.points[side[0]].z == 0 && m.points[side[1]].z == 0 && m.points[side[2]].z == 0 ? 0 : 1;
  });
  return mesh;
}

}  // namespace delquad::testing_support
