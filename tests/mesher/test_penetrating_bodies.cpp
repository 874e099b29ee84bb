// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/meshing.h"

namespace delquad {
namespace {

/// The unit cube and a copy that is moved and has another size.
MeshProblem two_cubes(const Vec3& shift, double size = 1) {
  Mesh mesh = box(2);
  append(mesh, box(2, size, size, size), shift);
  return problem_of(TriangleModel{std::move(mesh)}, 0.5);
}

TEST(PenetratingBodies, OfTriangulationsAreTold) {
  for (const auto& [shift, told] : {std::pair(Vec3{0.5, 0.4, 0.3}, true),
                                    {Vec3{1e-4, 0, 0}, true},
                                    {Vec3{1, 0.3, 0.3}, true},
                                    {Vec3{1.01, 0, 0}, false}}) {
    EXPECT_EQ(count_told(prepare(two_cubes(shift))->warnings,
                         "1 pair of bodies touch or go through each other and share no nodes: face"),
              told)
        << shift.x;
  }
}

TEST(PenetratingBodies, ThatLieOnEachOtherAreTold) {
  for (const auto& [shift, told] :
       {std::pair(Vec3{1, 0.3, 0.3}, true), {Vec3{1, 0.8, 0.8}, true}, {Vec3{1, 1, 0.3}, false}})
    EXPECT_EQ(count_told(prepare(two_cubes(shift, 0.4))->warnings, "face 2 on face 7 at"), told) << shift.y;
}

TEST(PenetratingBodies, WithACommonEdgeAreTold) {
  for (const auto& [shift, height, told] :
       {std::tuple(Vec3{1, 0, 0}, 0.5, true), {Vec3{1, 1, 0}, 1.0, false}, {Vec3{1, 0, 0}, 1.0, false}}) {
    Mesh mesh = box(1);
    append(mesh, box(1, 1, 1, height), shift);
    for (auto& triangle : mesh.triangles)
      for (int& v : triangle)
        v = static_cast<int>(std::ranges::find(mesh.points, mesh.points[v]) - mesh.points.begin());
    EXPECT_EQ(count_told(prepare(problem_of(TriangleModel{std::move(mesh)}, 0.5))->warnings,
                         "1 pair of bodies touch or go through each other"),
              told)
        << shift.y << ' ' << height;
  }
}

}  // namespace
}  // namespace delquad
