// SPDX-License-Identifier: GPL-3.0-or-later
#include <BRepAlgoAPI_Common.hxx>
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepOffsetAPI_ThruSections.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <GeomAPI_PointsToBSplineSurface.hxx>
#include <Geom_BSplineSurface.hxx>
#include <TColgp_Array2OfPnt.hxx>
#include <array>
#include <cmath>
#include <gp_Circ.hxx>
#include <gp_Elips.hxx>

#include "geometry/cad/examples/shapes.h"

namespace delquad::cad {

namespace {

TopoDS_Wire ellipse(double z, double major, double minor, const gp_Dir& along) {
  return BRepBuilderAPI_MakeWire(
             BRepBuilderAPI_MakeEdge(gp_Elips(gp_Ax2({0, 0, z}, {0, 0, 1}, along), major, minor)))
      .Wire();
}

}  // namespace

CadShape make_loft() {
  BRepOffsetAPI_ThruSections loft(/*isSolid=*/true, /*ruled=*/false);
  loft.AddWire(ellipse(0, 24, 12, {1, 0, 0}));
  loft.AddWire(ellipse(25, 14, 10, {0.8, 0.6, 0}));
  loft.AddWire(ellipse(50, 18, 8, {0.28, 0.96, 0}));
  loft.AddWire(ellipse(80, 11, 10, {0, 1, 0}));
  return {loft.Shape()};
}

CadShape make_free_form() {
  constexpr int kSide = 9;
  constexpr double kStep = 12.5;
  TColgp_Array2OfPnt points(1, kSide, 1, kSide);
  for (int i = 1; i <= kSide; ++i)
    for (int j = 1; j <= kSide; ++j) {
      const double x = kStep * (i - 1), y = kStep * (j - 1);
      points(i, j) = gp_Pnt(x, y, 10 * std::sin(x / 22) * std::cos(y / 17) + 0.004 * (x - 50) * (y - 50));
    }
  const Handle(Geom_Surface) surface(GeomAPI_PointsToBSplineSurface(points).Surface());
  TopoDS_Shape face = BRepBuilderAPI_MakeFace(surface, 1e-6).Shape();
  const auto drill = [&](double x, double y, double radius) {
    face =
        BRepAlgoAPI_Cut(face, BRepPrimAPI_MakeCylinder(gp_Ax2({x, y, -60}, {0, 0, 1}), radius, 120).Shape());
  };
  for (const auto& [x, y, r] :
       {std::array{30.0, 30.0, 11.0}, {68.0, 25.0, 6.0}, {60.0, 70.0, 14.0}, {100.0, 100.0, 25.0}})
    drill(x, y, r);
  return {face};
}

}  // namespace delquad::cad
