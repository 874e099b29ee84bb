// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/curved/jacobian_bounds.h"
#include "features/curved/untangle_curved.h"
#include "geometry/mesh/element_nodes.h"
#include "tests/support/meshing.h"

namespace delquad {
namespace {

/// One: a disc; two: what lies between.
MeshProblem circles(const std::vector<double>& radii, int order, double size) {
  ModelMaker model;
  for (const double r : radii) model.circle({0, 0}, r, r == 1 ? "outer" : "inner");
  MeshProblem problem = model.problem(size);
  problem.order = order;
  return problem;
}

double area(const Mesh& mesh) {
  double sum = 0;
  for (std::size_t q = 0; q < mesh.quads.size(); ++q) {
    std::vector<Vec3> places;
    for (const int v : nodes_of_quad(mesh, q)) places.push_back(mesh.points[v]);
    const Bernstein<Vec3> x = bernstein_of(places, mesh.order);
    const Bernstein<Vec3> normal = cross_product(derivative_u(x), derivative_v(x));
    for (const Vec3& c : normal.c) sum += c.z / static_cast<double>(normal.c.size());
  }
  return sum;
}

TEST(CurvedMesh, NodesLieOnTheCirclesAndAreasConverge) {
  double straight = 0;
  for (int order = 1; order <= kMostOrder; ++order) {
    const MeshResult result = mesh(circles({1}, order, 0.15), "DBCO");
    const Mesh& m = result.mesh;
    EXPECT_EQ(m.order, order);
    EXPECT_TRUE(check_invariants(m).empty());
    const double error = std::abs(area(m) - std::numbers::pi);
    if (order == 1) straight = error;
    // A chord of length h is off by h^2, a parabola by h^4, cubics too, quartics by h^6.
    if (order > 1) {
      EXPECT_LT(error, straight * (order == 4 ? 1e-4 : 0.01)) << order;
    }
    for (std::size_t l = 0; l < m.lines.size(); ++l)
      for (const int v : nodes_of_line(m, l)) {
        EXPECT_NEAR(norm(m.points[v]), 1, 1e-12);
      }
    for (const JacobianBounds& bounds : jacobian_bounds(m)) EXPECT_GT(bounds.proven, 0.3);
  }
}

TEST(CurvedMesh, ThinLayersOnCirclesStayPositive) {
  MeshProblem problem = circles({1, 0.4}, 2, 0.15);
  problem.layers.push_back({.on = {"inner"}, .first = 1e-4, .growth = 1.3, .thickness = 0.05});
  const MeshResult result = mesh(problem, "DBCO");
  EXPECT_EQ(result.mesh.order, 2);
  EXPECT_EQ(result.log.summaries.get<long long>("curving", "unproven"), 0);
  for (const JacobianBounds& bounds : jacobian_bounds(result.mesh)) EXPECT_GT(bounds.proven, 0.1);
}

TEST(CurvedMesh, NodesOfSpheresLieOnThem) {
  MeshProblem problem = problem_of(ExampleModel{"sphere"}, 0.4);
  problem.order = 2;
  const MeshResult result = mesh(problem, "DBCO");
  const double r = norm(result.mesh.points[0]);
  for (const Vec3& x : result.mesh.points) EXPECT_NEAR(norm(x), r, 1e-9);
  for (const JacobianBounds& bounds : jacobian_bounds(result.mesh)) EXPECT_GT(bounds.proven, 0.2);
}

TEST(CurvedMesh, TrianglesHaveNoHigherOrder) { EXPECT_THROW(mesh(circles({1}, 2, 0.15), "D"), InputError); }

}  // namespace
}  // namespace delquad
