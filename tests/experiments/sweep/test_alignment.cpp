// SPDX-License-Identifier: GPL-3.0-or-later
#include "delquad/mesher.h"
#include "tests/support/files.h"
#include "tests/support/triangulated_shapes.h"

namespace delquad {
namespace {

/// A lattice of half of the unit square's width about its middle, turned by an angle, at a height.
Mesh lattice(double degrees, double height) {
  Mesh mesh = quad_grid(8, 8);
  const double c = std::cos(degrees * std::numbers::pi / 180), s = std::sin(degrees * std::numbers::pi / 180);
  for (Vec3& p : mesh.points) {
    const double x = (p.x - 0.5) / 2, y = (p.y - 0.5) / 2;
    p = {0.5 + c * x - s * y, 0.5 + s * x + c * y, height};
  }
  return mesh;
}

double misalignment(const Prepared& prepared, const Mesh& mesh) {
  return prepared.metrics(mesh, "").values.at("misalignment");
}

TEST(Misalignment, IsTheAngleBetweenEdgesAndTheFieldOfThePlane) {
  MeshProblem problem;
  PlanarModel square;
  square.curves.emplace_back().shape = make_polyline({{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}});
  square.loops.emplace_back().curves = {0};
  problem.model = square;
  problem.size.text = "0.1";
  const Prepared along_sides = prepare(problem);
  for (const double degrees : {0.0, 15.0, 40.0, 45.0})
    EXPECT_NEAR(misalignment(along_sides, lattice(degrees, 0)), degrees, 1e-6);
  EXPECT_NEAR(misalignment(along_sides, lattice(60, 0)), 30, 1e-6) << "the nearest of the directions";
  problem.cross.text = "pi/12";
  EXPECT_NEAR(misalignment(prepare(problem), lattice(0, 0)), 15, 1e-6);
  EXPECT_TRUE(std::isnan(misalignment(along_sides, triangle_grid(4, 4))));
}

/// The sides of a box have fields along their edges.
TEST(Misalignment, IsTheSameOnSurfaces) {
  MeshProblem problem;
  problem.model = TriangleModel{testing_support::box(4)};
  problem.size.text = "0.1";
  const Prepared prepared = prepare(problem);
  for (const double degrees : {0.0, 15.0})
    EXPECT_NEAR(misalignment(prepared, lattice(degrees, 1)), degrees, 0.1);
  const MeshResult result = mesh(prepared, "DB");
  EXPECT_LT(result.metrics.values.at("misalignment"), 1);
}

}  // namespace
}  // namespace delquad
