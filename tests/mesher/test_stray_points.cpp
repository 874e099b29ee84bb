#include <gtest/gtest.h>

#include "delquad/mesher.h"
#include "fields/fields.h"
#include "geometry/mesh/stray_points.h"
#include "tests/support/expect_input_error.h"
#include "tests/support/triangulated_shapes.h"

namespace delquad {
namespace {

/// A box of which one vertex is pulled out on one of its triangles.
Mesh box_with_spike(double far) {
  Mesh mesh = testing_support::without_regions(testing_support::box(3));
  mesh.points.push_back({0, far, 0});
  mesh.triangles[5][1] = static_cast<int>(mesh.points.size()) - 1;
  return mesh;
}

MeshProblem spiked_problem(const Mesh& mesh) {
  MeshProblem problem;
  problem.model = TriangleModel{mesh, "case.stl"};
  problem.size.field = make_constant_size(0.3);
  return problem;
}

TEST(StrayPoints, FewThatLieFarBeyondTheOthers) {
  const auto n_strays = [](const Mesh& mesh) { return stray_points(mesh).size(); };
  EXPECT_EQ(n_strays(box_with_spike(0.45 * kStray)), 0u);
  EXPECT_EQ(n_strays(box_with_spike(0.7 * kStray)), 1u);
  EXPECT_EQ(n_strays(box_with_spike(-1e300)), 1u);
  Mesh unused = testing_support::box(3);
  unused.points.push_back({1e30, 0, 0});
  EXPECT_EQ(n_strays(unused), 0u);
  // A needle, where no part is the larger; a body whose parts differ by 10^12, with others between.
  EXPECT_EQ(n_strays(testing_support::box(1, 1, 1, 1e9)), 0u);
  Mesh nested;
  for (double scale = 1; scale < 1e13; scale *= 1e3) {
    const Mesh shell = testing_support::box(1, scale, scale, scale);
    const int first = static_cast<int>(nested.points.size());
    nested.points.insert(nested.points.end(), shell.points.begin(), shell.points.end());
    for (const auto& [a, b, c] : shell.triangles)
      nested.triangles.push_back({first + a, first + b, first + c});
  }
  EXPECT_EQ(n_strays(nested), 0u);
}

TEST(StrayPoints, AreRefusedOrLeftOut) {
  for (const double far : {1e30, 1e300, -6e4}) {
    MeshProblem problem = spiked_problem(box_with_spike(far));
    expect_input_error([&] { mesh(problem, "DBCO"); }, {"case.stl: the point (0, ", "times as far out"});
    problem.keep_going = true;
    const MeshResult result = mesh(problem, "DBCO");
    ASSERT_EQ(result.failures.size(), 1u);
    EXPECT_NE(result.failures[0].reason.find("case.stl: 1 element is missing: the point (0, "),
              std::string::npos)
        << result.failures[0].reason;
    EXPECT_GT(result.mesh.quads.size(), 50u);
    for (const Vec3& p : result.mesh.points) EXPECT_LT(norm(p), 2);
  }
}

}  // namespace
}  // namespace delquad
