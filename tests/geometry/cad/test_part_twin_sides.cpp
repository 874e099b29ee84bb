// SPDX-License-Identifier: GPL-3.0-or-later
#include <gp_Ax2.hxx>
#include "geometry/cad/weld_faces.h"
#include "geometry/mesh/check_invariants.h"
#include "tests/geometry/cad/cad_files.h"

namespace delquad {
namespace {

/// A pillow: two squares on the same four corners, each divided along the diagonal 0-2.
Mesh pillow() {
  Mesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {2, 1, 0}, {3, 2, 0}};
  mesh.triangle_region = {0, 0, 1, 1};
  mesh.regions = {{1, {}}, {2, {}}};
  return mesh;
}

TEST(PartTwinSides, GivesEachFaceItsOwnDiagonal) {
  Mesh mesh = pillow();
  const std::vector<std::array<int, 2>> square{{0, 1}, {0, 3}, {1, 2}, {2, 3}};
  const auto added = cad::split_duplicate_sides(mesh, {square, square});
  ASSERT_EQ(added.size(), 2u);
  EXPECT_EQ(added[0].face, 0);
  EXPECT_EQ(added[1].face, 1);
  EXPECT_EQ(mesh.points[added[1].point].x, 0.5);
  EXPECT_EQ(mesh.triangles.size(), 8u);
  const SurfaceCounts n = count(mesh);
  EXPECT_EQ(n.euler, 2);
  EXPECT_EQ(n.crowded_sides + n.free_sides, 0);
  EXPECT_DOUBLE_EQ(n.area, 2);
  EXPECT_EQ(n.volume, 0);
}

TEST(PartTwinSides, LeavesSidesOfTheBoundaryAlone) {
  // The diagonal is a curve in which the second face, too, touches itself.
  Mesh mesh = pillow();
  const std::vector<std::array<int, 2>> square{{0, 1}, {0, 3}, {1, 2}, {2, 3}};
  auto both = square;
  both.insert(both.begin() + 1, {0, 2});
  const auto added = cad::split_duplicate_sides(mesh, {square, both});
  ASSERT_EQ(added.size(), 1u);
  EXPECT_EQ(added[0].face, 0);
  EXPECT_EQ(count(mesh).crowded_sides, 0);
}

TEST(PartTwinSides, CrossingCylindersOfNearlyTheSameRadiusAreRead) {
  // Where the intersection curves nearly touch, sides of both faces join the same nodes of theirs.
  const auto along_x = BRepPrimAPI_MakeCylinder(gp_Ax2({0, 0, 0}, {1, 0, 0}), 0.5, 4).Shape();
  const auto along_z = BRepPrimAPI_MakeCylinder(gp_Ax2({2, 0, -2}, {0, 0, 1}), 0.499, 4).Shape();
  const SurfaceModel model = read_shape(BRepAlgoAPI_Cut(along_x, along_z).Shape());
  EXPECT_EQ(check_invariants(model.fine), std::vector<std::string>{});
  expect_sound(model);
  EXPECT_EQ(count(model.fine).crowded_sides, 0);
  EXPECT_EQ(count(model.fine).euler, 0);
}

}  // namespace
}  // namespace delquad
