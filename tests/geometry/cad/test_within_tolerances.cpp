// SPDX-License-Identifier: GPL-3.0-or-later
#include <BRepPrimAPI_MakePrism.hxx>
#include <BRepTools_ReShape.hxx>
#include <BRep_Tool.hxx>
#include <Geom_Circle.hxx>
#include <Geom_Line.hxx>
#include <TopExp.hxx>
#include "tests/geometry/cad/cad_files.h"

namespace delquad {
namespace {

/// Shapes that hold together only through the tolerances of their vertices.
class WithinTolerances : public ::testing::Test {
 protected:
  static TopoDS_Vertex vertex(double x, double y, double tolerance) {
    TopoDS_Vertex v;
    BRep_Builder().MakeVertex(v, gp_Pnt(x, y, 0), tolerance);
    return v;
  }
  static TopoDS_Edge edge(const Handle(Geom_Curve) & curve, double first, double last,
                          const TopoDS_Vertex& from, const TopoDS_Vertex& to) {
    TopoDS_Edge e;
    const BRep_Builder builder;
    builder.MakeEdge(e, curve, 1e-7);
    builder.Add(e, from.Oriented(TopAbs_FORWARD));
    builder.Add(e, to.Oriented(TopAbs_REVERSED));
    builder.Range(e, first, last);
    return e;
  }
  /// A quarter of a disk, one high, whose arc and first side run `past` each other: they cross near their
  /// common end.
  static TopoDS_Shape overshooting_quarter(double past, double tolerance) {
    const gp_Dir x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
    const TopoDS_Vertex centre = vertex(0, 0, 1e-7), top = vertex(0, 1, 1e-7),
                        end = vertex(1 + past / 2, -past / 2, tolerance);
    TopoDS_Wire wire;
    const BRep_Builder builder;
    builder.MakeWire(wire);
    builder.Add(wire, edge(new Geom_Line(gp_Pnt(0, 0, 0), x), 0, 1 + past, centre, end));
    builder.Add(wire,
                edge(new Geom_Circle(gp_Ax2(gp_Pnt(0, 0, 0), z), 1), -past, std::numbers::pi / 2, end, top));
    builder.Add(wire, edge(new Geom_Line(gp_Pnt(0, 0, 0), y), 0, 1, centre, top).Reversed());
    wire.Closed(true);
    return BRepPrimAPI_MakePrism(BRepBuilderAPI_MakeFace(gp_Pln(), wire).Face(), gp_Vec(0, 0, 1));
  }
  /// A cube with an edge cut off by `width`, the ends of the strip there drawn together in vertices.
  static TopoDS_Shape cube_with_strip(double width, double tolerance) {
    const TopoDS_Wire base = wire_of({{0, 0, 0}, {1, 0, 0}, {1, 1 - width, 0}, {1 - width, 1, 0}, {0, 1, 0}});
    const TopoDS_Shape cube =
        BRepPrimAPI_MakePrism(BRepBuilderAPI_MakeFace(gp_Pln(), base).Face(), gp_Vec(0, 0, 1));
    BRepTools_ReShape reshape;
    for (TopExp_Explorer e(cube, TopAbs_EDGE); e.More(); e.Next()) {
      TopoDS_Vertex from, to;
      TopExp::Vertices(TopoDS::Edge(e.Current()), from, to);
      if (BRep_Tool::Pnt(from).Distance(BRep_Tool::Pnt(to)) > 2 * width || reshape.IsRecorded(from)) continue;
      TopoDS_Vertex common;
      BRep_Builder().MakeVertex(common, BRep_Tool::Pnt(from), tolerance);
      reshape.Replace(from, common.Oriented(from.Orientation()));
      reshape.Replace(to, common.Oriented(to.Orientation()));
      reshape.Remove(e.Current());
    }
    return reshape.Apply(cube);
  }
  SurfaceModel read(const TopoDS_Shape& shape) { return read_shape(shape); }
  void expect_closed(const SurfaceModel& model, double volume, double accuracy) {
    expect_sound(model);
    const SurfaceCounts counts = count(model.fine);
    EXPECT_EQ(counts.free_sides, 0);
    EXPECT_EQ(counts.crowded_sides, 0);
    EXPECT_EQ(counts.euler, 2);
    EXPECT_NEAR(counts.volume, volume, accuracy);
    EXPECT_TRUE(model.left_out.empty());
  }
};

TEST_F(WithinTolerances, OutlineThatCrossesItselfWithinAVertexIsMeshed) {
  expect_closed(read(overshooting_quarter(0.08, 0.08)), std::numbers::pi / 4, 0.08);
}

TEST_F(WithinTolerances, StripBetweenTwoVerticesIsTakenOut) {
  const SurfaceModel model = read(cube_with_strip(1e-4, 2e-4));
  expect_closed(model, 1, 1e-3);
  EXPECT_EQ(model.fine.regions.size(), 6u);
  EXPECT_EQ(model.fine.curves.size(), 12u);
  ASSERT_FALSE(model.warnings.empty());
  EXPECT_TRUE(holds(model.warnings[0].text, "were removed, and their edges sewn: "));
}

}  // namespace
}  // namespace delquad
