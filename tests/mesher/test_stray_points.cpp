// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/mesh/stray_points.h"
#include "tests/support/meshing.h"

namespace delquad {
namespace {

/// A box of which one vertex is pulled out on one of its triangles.
Mesh box_with_spike(double far) {
  Mesh mesh = without_regions(box(3));
  mesh.points.push_back({0, far, 0});
  mesh.triangles[5][1] = static_cast<int>(mesh.points.size()) - 1;
  return mesh;
}

MeshProblem spiked_problem(const Mesh& mesh) { return problem_of(TriangleModel{mesh, "case.stl"}, 0.3); }

TEST(StrayPoints, FewThatLieFarBeyondTheOthers) {
  const auto n_strays = [](const Mesh& mesh) { return stray_points(mesh).size(); };
  EXPECT_EQ(n_strays(box_with_spike(0.45 * kStray)), 0u);
  EXPECT_EQ(n_strays(box_with_spike(0.7 * kStray)), 1u);
  EXPECT_EQ(n_strays(box_with_spike(-1e300)), 1u);
  Mesh unused = box(3);
  unused.points.push_back({1e30, 0, 0});
  EXPECT_EQ(n_strays(unused), 0u);
  // A needle, where no part is the larger; a body whose parts differ by 10^12, with others between.
  EXPECT_EQ(n_strays(box(1, 1, 1, 1e9)), 0u);
  Mesh nested;
  for (double scale = 1; scale < 1e13; scale *= 1e3) append(nested, box(1, scale, scale, scale));
  EXPECT_EQ(n_strays(nested), 0u);
}

TEST(StrayPoints, AreRefusedOrLeftOut) {
  for (const double far : {1e30, 1e300, -6e4}) {
    MeshProblem problem = spiked_problem(box_with_spike(far));
    expect_refused(problem, "DBCO", {"case.stl: the point (0, ", "times as far out"});
    problem.keep_going = true;
    const MeshResult result = mesh(problem, "DBCO");
    ASSERT_EQ(result.failures.size(), 1u);
    EXPECT_TRUE(holds(result.failures[0].reason, "case.stl: 1 element is missing: the point (0, "));
    EXPECT_GT(result.mesh.quads.size(), 50u);
    for (const Vec3& p : result.mesh.points) EXPECT_LT(norm(p), 2);
  }
}

}  // namespace
}  // namespace delquad
