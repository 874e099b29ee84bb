#include <gtest/gtest.h>

#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakePolygon.hxx>
#include <BRepBuilderAPI_MakeVertex.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepPrimAPI_MakeRevol.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <BRep_Builder.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Shell.hxx>
#include <TopoDS_Vertex.hxx>
#include <algorithm>
#include <array>
#include <filesystem>
#include <gp_Ax1.hxx>
#include <gp_Pln.hxx>
#include <numbers>

#include "delquad/mesher.h"
#include "tests/geometry/cad/cad_files.h"
#include "tests/support/expect_input_error.h"
#include "tests/support/temporary_folder.h"

namespace delquad {
namespace {

using namespace testing_support;

/// Faces that touch themselves or each other in points, or along edges that nothing else tells of.
class TouchingFaces : public ::testing::Test {
 protected:
  static MeshResult mesh_of(const std::filesystem::path& file, double size) {
    MeshProblem problem;
    problem.model = CadModel{file};
    problem.size.field = make_constant_size(size);
    problem.allow_unsound = true;
    return mesh(problem, "good");
  }

  TemporaryFolder folder_;
};

// Its inner circle is a point.
TEST_F(TouchingFaces, ATorusOfEqualRadiiIsRefusedWithItsPlace) {
  const auto file = write_step(folder_ / "torus.step", BRepPrimAPI_MakeTorus(2, 2).Shape());
  expect_input_error([&] { mesh_of(file, 1); }, {"face 1: its curve", "has no length", "(0, 0, 0)"});
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

/// A plate with two holes side by side. Each has its own edge on the side between them, and a wall hangs on
/// one of these edges.
TopoDS_Shape plate_with_holes_side_by_side() {
  const auto edge = [](const TopoDS_Vertex& a, const TopoDS_Vertex& b) {
    return BRepBuilderAPI_MakeEdge(a, b).Edge();
  };
  const auto vertex = [](double x, double y, double z = 0) {
    return BRepBuilderAPI_MakeVertex(gp_Pnt(x, y, z)).Vertex();
  };
  const auto loop = [](const std::array<TopoDS_Edge, 4>& e) {
    return BRepBuilderAPI_MakeWire(e[0], e[1], e[2], e[3]).Wire();
  };
  const std::array corner = {vertex(-6, -6), vertex(6, -6), vertex(6, 6), vertex(-6, 6)};
  const TopoDS_Vertex a = vertex(-1, 0), b = vertex(1, 0);
  const TopoDS_Edge below = edge(a, b), above = edge(b, a);
  const std::array low = {vertex(-1, -3), vertex(1, -3)}, high = {vertex(-1, 3), vertex(1, 3)};
  const std::array deep = {vertex(-1, 0, -2), vertex(1, 0, -2)};
  BRepBuilderAPI_MakeFace plate(gp_Pln(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1)),
                                loop({edge(corner[0], corner[1]), edge(corner[1], corner[2]),
                                      edge(corner[2], corner[3]), edge(corner[3], corner[0])}));
  plate.Add(loop({below, edge(b, low[1]), edge(low[1], low[0]), edge(low[0], a)}));
  plate.Add(loop({above, edge(a, high[0]), edge(high[0], high[1]), edge(high[1], b)}));
  const TopoDS_Face wall =
      BRepBuilderAPI_MakeFace(loop({above, edge(a, deep[0]), edge(deep[0], deep[1]), edge(deep[1], b)}));
  const BRep_Builder builder;
  TopoDS_Shell shell;
  builder.MakeShell(shell);
  builder.Add(shell, plate.Face());
  builder.Add(shell, wall);
  return shell;
}

TEST_F(TouchingFaces, HolesMayShareASide) {
  const auto file = write_brep(folder_ / "holes.brep", plate_with_holes_side_by_side());
  const MeshResult result = mesh_of(file, 0.5);
  EXPECT_TRUE(result.soundness.sound()) << result.soundness.text();
  const auto is_between = [&](const std::array<int, 2>& line) {
    return std::ranges::all_of(line, [&](int v) {
      const Vec3& p = result.mesh.points[v];
      return p.y == 0 && p.z == 0;
    });
  };
  EXPECT_EQ(std::ranges::count_if(result.mesh.lines, is_between), 4) << "one curve of 4 edges";
}

}  // namespace
}  // namespace delquad
