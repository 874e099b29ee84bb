#include <gtest/gtest.h>

#include <algorithm>

#include "delquad/mesher.h"
#include "tests/support/triangulated_shapes.h"

namespace delquad {
namespace {

/// The unit cube and a copy that is moved.
MeshProblem two_cubes(const Vec3& shift) {
  Mesh mesh = testing_support::box(2);
  const int n_points = static_cast<int>(mesh.points.size());
  const Mesh cube = mesh;
  for (const Vec3& x : cube.points) mesh.points.push_back(x + shift);
  for (const auto& [a, b, c] : cube.triangles)
    mesh.triangles.push_back({a + n_points, b + n_points, c + n_points});
  mesh.triangle_region.insert(mesh.triangle_region.end(), cube.triangle_region.begin(),
                              cube.triangle_region.end());
  MeshProblem problem;
  problem.model = TriangleModel{std::move(mesh)};
  problem.size.field = make_constant_size(0.5);
  return problem;
}

TEST(PenetratingBodies, OfTriangulationsAreTold) {
  for (const auto& [shift, is_told] : {std::pair(Vec3{0.5, 0.4, 0.3}, true),
                                       {Vec3{1e-4, 0, 0}, true},
                                       {Vec3{1, 0.3, 0.3}, true},
                                       {Vec3{1.01, 0, 0}, false}}) {
    const Prepared prepared = prepare(two_cubes(shift));
    const auto told = std::ranges::count_if(prepared->warnings, [](const Warning& w) {
      return w.text.find("1 pair of bodies touch or go through each other and share no nodes: face") !=
             std::string::npos;
    });
    EXPECT_EQ(told, is_told ? 1 : 0) << shift.x;
  }
}

}  // namespace
}  // namespace delquad
