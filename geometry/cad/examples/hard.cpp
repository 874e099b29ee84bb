#include <BRepAlgoAPI_Cut.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakePolygon.hxx>
#include <BRepFilletAPI_MakeChamfer.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRep_Builder.hxx>
#include <GeomAPI_PointsToBSplineSurface.hxx>
#include <Geom_BSplineSurface.hxx>
#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TColgp_Array2OfPnt.hxx>
#include <TopExp.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <array>
#include <cmath>
#include <gp_Pln.hxx>
#include <vector>

#include "geometry/cad/examples/shapes.h"

namespace delquad::cad {

namespace {

TopoDS_Wire polygon(const std::vector<gp_Pnt>& corners) {
  BRepBuilderAPI_MakePolygon wire;
  for (const gp_Pnt& p : corners) wire.Add(p);
  wire.Close();
  return wire.Wire();
}

TopoDS_Face rectangle(const gp_Pnt& corner, const gp_Vec& u, const gp_Vec& v) {
  return BRepBuilderAPI_MakeFace(
             polygon({corner, corner.Translated(u), corner.Translated(u + v), corner.Translated(v)}), true)
      .Face();
}

TopoDS_Shape beside(const std::vector<TopoDS_Shape>& shapes) {
  TopoDS_Compound all;
  const BRep_Builder builder;
  builder.MakeCompound(all);
  for (const TopoDS_Shape& shape : shapes) builder.Add(all, shape);
  return all;
}

}  // namespace

CadShape make_seam_groove() {
  constexpr double kGroove = 0.06, kSide = 60;
  const TopoDS_Shape shaft = cylinder({0, 0, 0}, {0, 0, 1}, 10, 40);
  const gp_Ax2 aslant({-kSide / 2, -kSide / 2, 28}, {0.28, 0, 0.96}, {0.96, 0, -0.28});
  const TopoDS_Shape slice = BRepPrimAPI_MakeBox(aslant, kSide, kSide, kGroove).Shape();
  return {BRepAlgoAPI_Cut(shaft, BRepAlgoAPI_Cut(slice, cylinder({0, 0, -1}, {0, 0, 1}, 9, 50)))};
}

CadShape make_narrow_chamfer() {
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(60, 40, 20).Shape();
  BRepFilletAPI_MakeChamfer chamfer(box);
  const TopTools_IndexedMapOfShape edges = parts(box, TopAbs_EDGE);
  for (int e = 1; e <= edges.Extent(); ++e) chamfer.Add(0.02, TopoDS::Edge(edges(e)));
  return {BRepAlgoAPI_Cut(chamfer.Shape(), cylinder({30, 20, -1}, {0, 0, 1}, 8, 22))};
}

CadShape make_tiny_edges() {
  constexpr int kSides = 9;
  constexpr double kTiny = 2e-3;
  std::vector<gp_Pnt> corners;
  for (int k = 0; k < kSides; ++k) {
    const double angle = 2 * M_PI * k / kSides, next = angle + 2 * M_PI / kSides;
    const gp_Pnt from(25 * std::cos(angle), 25 * std::sin(angle), 0),
        to(25 * std::cos(next), 25 * std::sin(next), 0);
    const gp_Vec along = gp_Vec(from, to).Normalized();
    corners.push_back(from.Translated(kTiny * along));
    corners.push_back(to.Translated(-kTiny * along));
  }
  const TopoDS_Face base = BRepBuilderAPI_MakeFace(polygon(corners), true);
  return {BRepPrimAPI_MakePrism(base, gp_Vec(0, 0, 20))};
}

CadShape make_bodies_on_bodies() {
  constexpr double kOff = 1e-5;
  const auto box = [](const gp_Pnt& corner, double x, double y, double z) {
    return BRepPrimAPI_MakeBox(corner, x, y, z).Shape();
  };
  return {beside({box({0, 0, 0}, 50, 40, 15), box({5, 8, 15 - kOff}, 30, 24, 10), box({50, 0, 0}, 20, 40, 15),
                  box({70, 40, 0}, 20, 20, 15)})};
}

CadShape make_crossing_webs() {
  const auto along = [](const gp_Vec& side) { return rectangle({0, 20, 0}, {60, 0, 0}, side); };
  return {beside({along({0, 20, 0}), along({0, -20, 0}), along({0, 0, 15}), along({0, 0, -10}),
                  rectangle({20, 28, 0}, {25, 4, 0}, {0, 0, 12})})};
}

CadShape make_pole_wedge() { return {BRepPrimAPI_MakeSphere(gp_Ax2(), 30, 0.12)}; }

CadShape make_stalled_spline() {
  constexpr int kSide = 7;
  // Three equal points in a row: there the surface has no derivative along it.
  constexpr std::array kAlong = {0.0, 18.0, 45.0, 45.0, 45.0, 80.0, 100.0};
  TColgp_Array2OfPnt points(1, kSide, 1, kSide);
  for (int i = 1; i <= kSide; ++i)
    for (int j = 1; j <= kSide; ++j)
      points(i, j) =
          gp_Pnt(kAlong[i - 1], 10.0 * (j - 1), 8 * std::sin(kAlong[i - 1] / 20) * std::cos(j - 1.0));
  TColStd_Array1OfReal knots(1, 5);
  TColStd_Array1OfInteger times(1, 5);
  for (int k = 1; k <= 5; ++k) knots(k) = k, times(k) = k == 1 || k == 5 ? 4 : 1;
  const Handle(Geom_Surface) surface = new Geom_BSplineSurface(points, knots, knots, times, times, 3, 3);
  return {BRepBuilderAPI_MakeFace(surface, 1e-6).Shape()};
}

CadShape make_near_radii() {
  const TopoDS_Shape along_x = cylinder({-40, 0, 0}, {1, 0, 0}, 10, 80),
                     along_z = cylinder({0, 0, -40}, {0, 0, 1}, 9.98, 80);
  return {BRepAlgoAPI_Cut(along_x, along_z)};
}

CadShape make_touching_holes() {
  BRepBuilderAPI_MakeFace plate(gp_Pln(), polygon({{0, 0, 0}, {60, 0, 0}, {60, 40, 0}, {0, 40, 0}}));
  const auto hole = [&](double x, double y, double side) {
    plate.Add(TopoDS::Wire(
        polygon({{x, y, 0}, {x + side, y, 0}, {x + side, y + side, 0}, {x, y + side, 0}}).Reversed()));
  };
  hole(8, 8, 10);
  hole(18, 18, 12);  // touches the first with a corner
  hole(36, 10, 8);
  hole(44, 12, 6);                                                            // with a side
  plate.Add(TopoDS::Wire(polygon({{50, 40, 0}, {46, 30, 0}, {54, 28, 0}})));  // and this one the outline
  return {plate.Face()};
}

}  // namespace delquad::cad
