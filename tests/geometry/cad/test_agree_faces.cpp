// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cad/agree_faces.h"
#include "tests/geometry/cad/cad_files.h"

namespace delquad {
namespace {

/// A tetrahedron of four faces, normals outwards.
Mesh tetrahedron() {
  Mesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  mesh.triangle_region = {0, 1, 2, 3};
  mesh.regions = {{1, {}}, {2, {}}, {3, {}}, {4, {}}};
  return mesh;
}

TEST(AgreeFaces, TurnsTheFewest) {
  Mesh mesh = tetrahedron();
  std::swap(mesh.triangles[0][1], mesh.triangles[0][2]);
  const cad::Agreement agreement = cad::agree_faces(mesh);
  EXPECT_EQ(agreement.n_turned, 1);
  EXPECT_TRUE(agreement.orientable);
  EXPECT_EQ(mesh.triangles, tetrahedron().triangles);
}

TEST(AgreeFaces, KnowsAMoebiusStrip) {
  Mesh mesh;
  for (int k = 0; k < 3; ++k) {
    mesh.points.push_back({k * 1.0, 0, 0});
    mesh.points.push_back({k * 1.0, 1, k * 0.5});
  }
  // Three strips; the last joins with its ends exchanged.
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {2, 4, 5}, {2, 5, 3}, {4, 1, 0}, {4, 0, 5}};
  mesh.triangle_region = {0, 0, 1, 1, 2, 2};
  mesh.regions = {{1, {}}, {2, {}}, {3, {}}};
  EXPECT_FALSE(cad::agree_faces(mesh).orientable);
}

TEST(TurnOutwards, TurnsClosedGroupsOnly) {
  Mesh mesh = tetrahedron();
  for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  const Mesh inside_out = mesh;
  EXPECT_EQ(cad::turn_outwards(mesh, {{0, 1, 2}}), 0);
  EXPECT_EQ(mesh.triangles, inside_out.triangles);
  EXPECT_EQ(cad::turn_outwards(mesh, {{0, 1, 2, 3}}), 1);
  EXPECT_EQ(mesh.triangles, tetrahedron().triangles);
  EXPECT_EQ(cad::turn_outwards(mesh, {{0, 1, 2, 3}}), 0);
}

}  // namespace
}  // namespace delquad
