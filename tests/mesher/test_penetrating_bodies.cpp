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

}  // namespace
}  // namespace delquad
