#include "tests/support/meshing.h"

namespace delquad {
namespace {

/// The unit cube and a copy that is moved.
MeshProblem two_cubes(const Vec3& shift) {
  Mesh mesh = box(2);
  append(mesh, mesh, shift);
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

}  // namespace
}  // namespace delquad
