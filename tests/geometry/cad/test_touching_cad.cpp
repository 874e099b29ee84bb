// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/mesh/check_invariants.h"
#include "tests/geometry/cad/cad_files.h"

namespace delquad {
namespace {

class TouchingCad : public ::testing::Test {
 protected:
  /// As faces that nothing joins.
  static TopoDS_Shape loose_faces(const std::vector<TopoDS_Shape>& bodies) {
    return compound_of(faces_of(compound_of(bodies)));
  }
  static TopoDS_Shape box(double x, double y, double z, double a, double b, double c) {
    return BRepPrimAPI_MakeBox(gp_Pnt(x, y, z), a, b, c).Shape();
  }
  /// Closed bodies by themselves, as many.
  void expect_apart(const std::vector<TopoDS_Shape>& bodies) {
    const TopoDS_Shape faces = loose_faces(bodies);
    for (const auto& path : {write_iges(folder_ / "a.igs", faces), write_step(folder_ / "a.step", faces)}) {
      SCOPED_TRACE(path);
      const SurfaceModel model = read_cad(path);
      const SurfaceCounts counts = count(model.fine);
      EXPECT_EQ(counts.free_sides, 0);
      EXPECT_EQ(counts.crowded_sides, 0);
      EXPECT_EQ(counts.euler, 2 * static_cast<int>(bodies.size()));
      ASSERT_FALSE(model.warnings.empty());
      EXPECT_TRUE(holds(model.warnings[0].text, "sewn one by one: " + std::to_string(bodies.size())));
    }
  }

  static std::vector<gp_Pnt> square(double x, double y, double side) {
    return {{x, y, 0}, {x + side, y, 0}, {x + side, y + side, 0}, {x, y + side, 0}};
  }
  /// The face in the plane z = 0; every line of its triangulation is a side of a triangle.
  void expect_face(const std::vector<std::vector<gp_Pnt>>& wires, double area, int euler) {
    BRepBuilderAPI_MakeFace face(gp_Pln(), wire_of(wires[0]));
    for (std::size_t w = 1; w < wires.size(); ++w) face.Add(TopoDS::Wire(wire_of(wires[w]).Reversed()));
    const SurfaceModel model = read_shape(face.Face());
    EXPECT_NEAR(count(model.fine).area, area, 1e-12);
    EXPECT_EQ(count(model.fine).euler, euler);
    const std::vector<std::string> wrong = check_invariants(model.fine, {});
    EXPECT_TRUE(wrong.empty()) << wrong[0];
  }

  TemporaryFolder folder_;
};

TEST_F(TouchingCad, BodiesAlongAnEdgeStayApart) {
  expect_apart({box(0, 0, 0, 1, 1, 1), box(1, 1, 0, 1, 1, 1)});
}

TEST_F(TouchingCad, BodiesWithFacesOnEachOtherStayApart) {
  expect_apart({box(0, 0, 0, 4, 4, 1), box(0, 0, 1, 4, 4, 1), box(4, 0, 0, 4, 4, 1), box(4, 0, 1, 2, 2, 1)});
}

TEST_F(TouchingCad, ABodyAmongEqualOnesStaysApart) {
  std::vector<TopoDS_Shape> bodies;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) bodies.push_back(box(i, j, 0, 1, 1, 1));
  expect_apart(bodies);
}

const std::vector<gp_Pnt> kOuter = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}};

TEST_F(TouchingCad, AHoleAlongASide) {
  expect_face({kOuter, {{0, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}}}, 15, 1);
}

TEST_F(TouchingCad, HolesWithASide) { expect_face({kOuter, square(1, 1, 1), square(2, 1, 1)}, 14, 0); }

TEST_F(TouchingCad, HolesAndOutlinesWithAPoint) {
  expect_face({kOuter, square(1, 1, 1), square(2, 2, 1)}, 14, -1);
  expect_face({kOuter, {{0, 0, 0}, {2, 1, 0}, {1, 2, 0}}}, 14.5, 0);
  expect_face({{{0, 0, 0}, {2, 1, 0}, {4, 0, 0}, {4, 2, 0}, {2, 1, 0}, {0, 2, 0}}}, 4, 1);
}

TEST_F(TouchingCad, AWireThatRunsAlongAnEdgeTwice) {
  const std::vector<gp_Pnt> at = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0},
                                  {1, 1, 0}, {1, 3, 0}, {3, 3, 0}, {3, 1, 0}};
  const BRep_Builder builder;
  std::vector<TopoDS_Vertex> v(at.size());
  for (std::size_t i = 0; i < at.size(); ++i) builder.MakeVertex(v[i], at[i], 1e-7);
  const auto edge = [&](int i, int j) { return BRepBuilderAPI_MakeEdge(v[i], v[j]).Edge(); };
  TopoDS_Wire wire;
  builder.MakeWire(wire);
  const TopoDS_Edge seam = edge(0, 4);
  for (const TopoDS_Edge& e :
       {edge(0, 1), edge(1, 2), edge(2, 3), edge(3, 0), seam, edge(4, 5), edge(5, 6), edge(6, 7), edge(7, 4)})
    builder.Add(wire, e);
  builder.Add(wire, seam.Reversed());
  const SurfaceModel model = read_shape(BRepBuilderAPI_MakeFace(gp_Pln(), wire).Face());
  EXPECT_NEAR(count(model.fine).area, 12, 1e-12);
  EXPECT_EQ(count(model.fine).euler, 0);
}

}  // namespace
}  // namespace delquad
