// SPDX-License-Identifier: GPL-3.0-or-later
#include <BRepPrimAPI_MakeRevol.hxx>
#include <gp_Ax1.hxx>
#include "tests/geometry/cad/cad_files.h"

namespace delquad {
namespace {

/// Faces that touch themselves or each other in points.
class TouchingFaces : public ::testing::Test {
 protected:
  static MeshResult mesh_of(const std::filesystem::path& file, double size) {
    MeshProblem problem = problem_of(CadModel{file}, size);
    problem.allow_unsound = true;
    return mesh(problem, "good");
  }

  TemporaryFolder folder_;
};

// Its inner circle is a point.
TEST_F(TouchingFaces, ATorusOfEqualRadiiIsRefusedWithItsPlace) {
  const auto file = write_step(folder_ / "torus.step", BRepPrimAPI_MakeTorus(2, 2).Shape());
  expect_input_error([&] { mesh_of(file, 1); }, {"face 1 could not be flattened", "look between ("});
}

// A triangle that touches the axis in a corner makes two cones with one tip.
TEST_F(TouchingFaces, ConesMayShareTheirTip) {
  BRepBuilderAPI_MakePolygon triangle(gp_Pnt(0, 0, 0), gp_Pnt(10, 0, 3), gp_Pnt(6, 0, 9), true);
  const gp_Ax1 axis(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1));
  const TopoDS_Shape cones =
      BRepPrimAPI_MakeRevol(BRepBuilderAPI_MakeFace(triangle.Wire()).Shape(), axis, 2 * std::numbers::pi)
          .Shape();
  const MeshResult result = mesh_of(write_step(folder_ / "cones.step", cones), 1.5);
  EXPECT_TRUE(result.soundness.sound()) << result.soundness.text();
  EXPECT_TRUE(result.surface->mesh.watertight());
}

}  // namespace
}  // namespace delquad
