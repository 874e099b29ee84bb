// SPDX-License-Identifier: GPL-3.0-or-later
#include <BRepBuilderAPI_MakeVertex.hxx>
#include "tests/geometry/cad/cad_files.h"

namespace delquad {
namespace {

MeshResult mesh_of(const std::filesystem::path& file, double size) {
  MeshProblem problem = problem_of(CadModel{file}, size);
  return mesh(problem, "DBCO");
}

/// Length of the lines both of whose ends lie in the set.
template <class In>
double length_in(const Mesh& mesh, In in) {
  double sum = 0;
  for (const auto& [a, b] : mesh.lines)
    if (in(mesh.points[a]) && in(mesh.points[b])) sum += norm(mesh.points[b] - mesh.points[a]);
  return sum;
}

class LooseEdges : public ::testing::Test {
 protected:
  TemporaryFolder folder_;
};

TEST_F(LooseEdges, EdgesAndVerticesInsideOfAFaceStay) {
  TopoDS_Face face = BRepBuilderAPI_MakeFace(gp_Pln(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1)), 0, 4, 0, 2).Face();
  const BRep_Builder builder;
  const TopoDS_Edge segment = BRepBuilderAPI_MakeEdge(gp_Pnt(1, 0.5, 0), gp_Pnt(2, 1.25, 0)).Edge();
  const TopoDS_Edge circle =
      BRepBuilderAPI_MakeEdge(gp_Circ(gp_Ax2(gp_Pnt(3, 1, 0), gp_Dir(0, 0, 1)), 0.5)).Edge();
  const TopoDS_Vertex vertex = BRepBuilderAPI_MakeVertex(gp_Pnt(0.5, 1.5, 0)).Vertex();
  for (const TopoDS_Edge& edge : {segment, circle}) {
    TopoDS_Wire wire;
    builder.MakeWire(wire);
    builder.Add(wire, edge.Oriented(TopAbs_INTERNAL));
    builder.Add(face, wire);
  }
  builder.Add(face, vertex.Oriented(TopAbs_INTERNAL));
  const MeshResult result = mesh_of(write_brep(folder_ / "inside.brep", face), 0.2);
  EXPECT_TRUE(result.soundness.sound());
  EXPECT_TRUE(result.mesh.triangles.empty());
  const auto on_segment = [](const Vec3& p) {
    return std::abs(0.75 * (p.x - 1) - (p.y - 0.5)) < 1e-9 && p.x > 1 - 1e-9 && p.x < 2 + 1e-9;
  };
  EXPECT_NEAR(length_in(result.mesh, on_segment), 1.25, 1e-9);
  // Nodes lie on the chords, and the mesh's edges are chords of these.
  const auto on_circle = [](const Vec3& p) { return std::abs(std::hypot(p.x - 3, p.y - 1) - 0.5) < 1e-4; };
  EXPECT_NEAR(length_in(result.mesh, on_circle), 3.14159265, 0.05);
  EXPECT_TRUE(std::ranges::any_of(result.mesh.points, [](const Vec3& p) {
    return norm(p - Vec3{0.5, 1.5, 0}) < 1e-9;
  }));
}

TEST_F(LooseEdges, ThoseThatLieOnAFaceAreImprintedAndOthersNamed) {
  const TopoDS_Shape all = compound_of({BRepPrimAPI_MakeCylinder(1, 4),
                                        BRepBuilderAPI_MakeEdge(gp_Pnt(-1, 0, 1), gp_Pnt(-1, 0, 3)),
                                        BRepBuilderAPI_MakeEdge(gp_Pnt(5, 0, 1), gp_Pnt(5, 0, 3))});
  const auto file = write_brep(folder_ / "beside.brep", all);
  const SurfaceModel model = read_cad(file);
  ASSERT_EQ(model.loose.size(), 2u);
  const MeshResult result = mesh_of(file, 0.4);
  EXPECT_TRUE(result.soundness.sound());
  const auto on_line = [](const Vec3& p) {
    return norm(p - Vec3{-1, 0, p.z}) < 1e-9 && p.z > 0.5 && p.z < 3.5;
  };
  EXPECT_NEAR(length_in(result.mesh, on_line), 2, 1e-6);
  EXPECT_TRUE(is_reported(result.warnings, model.loose[1].where + " is left out"));
}

}  // namespace
}  // namespace delquad
