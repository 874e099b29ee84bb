// SPDX-License-Identifier: GPL-3.0-or-later
#include <BRepAdaptor_Curve.hxx>
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepFilletAPI_MakeFillet.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <GC_MakeArcOfCircle.hxx>
#include <TopExp.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <cmath>
#include <numbers>

#include "geometry/cad/examples/shapes.h"

namespace delquad::cad {

TopoDS_Shape cylinder(const gp_Pnt& from, const gp_Dir& along, double radius, double length) {
  return BRepPrimAPI_MakeCylinder(gp_Ax2(from, along), radius, length).Shape();
}

namespace {

/// Returns the straight edges along a direction.
TopTools_IndexedMapOfShape edges_along(const TopoDS_Shape& shape, const gp_Dir& direction) {
  const TopTools_IndexedMapOfShape edges = parts(shape, TopAbs_EDGE);
  TopTools_IndexedMapOfShape found;
  for (int e = 1; e <= edges.Extent(); ++e) {
    const BRepAdaptor_Curve curve(TopoDS::Edge(edges(e)));
    if (curve.GetType() == GeomAbs_Line && curve.Line().Direction().IsParallel(direction, 1e-6))
      found.Add(edges(e));
  }
  return found;
}

}  // namespace

CadShape make_sphere() { return {BRepPrimAPI_MakeSphere(10)}; }

CadShape make_torus() { return {BRepPrimAPI_MakeTorus(20, 8)}; }

CadShape make_variable_fillet() {
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(80, 50, 30).Shape();
  BRepFilletAPI_MakeFillet fillet(box);
  const TopTools_IndexedMapOfShape along = edges_along(box, {1, 0, 0});
  for (int e = 1; e <= along.Extent(); ++e) fillet.Add(2, 3.0 * e, TopoDS::Edge(along(e)));
  return {BRepAlgoAPI_Cut(fillet.Shape(), cylinder({40, 25, -1}, {0, 0, 1}, 8, 32))};
}

CadShape make_sheet() {
  constexpr double kWidth = 60, kLength = 100, kRadius = 6;
  const gp_Pnt bend(kLength, 0, 0), side(kLength + kRadius, 0, kRadius);
  const double along = kRadius * std::numbers::sqrt2 / 2;
  BRepBuilderAPI_MakeWire profile;
  profile.Add(BRepBuilderAPI_MakeEdge(gp_Pnt(0, 0, 0), bend));
  profile.Add(BRepBuilderAPI_MakeEdge(
      GC_MakeArcOfCircle(bend, gp_Pnt(kLength + along, 0, kRadius - along), side).Value()));
  profile.Add(BRepBuilderAPI_MakeEdge(side, gp_Pnt(kLength + kRadius, 0, 40)));
  TopoDS_Shape sheet = BRepPrimAPI_MakePrism(profile.Wire(), gp_Vec(0, kWidth, 0));
  const auto cut = [&](const TopoDS_Shape& tool) { sheet = BRepAlgoAPI_Cut(sheet, tool); };
  for (const double y : {18.0, 42.0}) cut(cylinder({25, y, -1}, {0, 0, 1}, 5, 2));
  cut(cylinder({kLength - 5, 30, 24}, {1, 0, 0}, 8, 20));
  // Two holes that leave a web of 0.2 between them, a step of 0.3 in the outline, and a pinhole.
  for (const double x : {60.0, 70.2}) cut(cylinder({x, 30, -1}, {0, 0, 1}, 5, 2));
  cut(BRepPrimAPI_MakeBox(gp_Pnt(-1, kWidth - 0.3, -1), 46, 1, 2));
  cut(cylinder({85, 12, -1}, {0, 0, 1}, 0.2, 2));
  return {sheet};
}

CadShape make_thin_box() {
  constexpr double kWall = 1.5;
  TopoDS_Shape box = BRepPrimAPI_MakeBox(80, 60, 30).Shape();
  const auto room = [&](double x, double y) {
    const gp_Pnt low(x, y, kWall);
    return BRepPrimAPI_MakeBox(low, 38.5 - kWall / 2 + 0.25, 28.5 - kWall / 2 + 0.25, 40).Shape();
  };
  for (const double x : {kWall, 40 + kWall / 2})
    for (const double y : {kWall, 30 + kWall / 2}) box = BRepAlgoAPI_Cut(box, room(x, y));
  for (const double x : {20.0, 60.0}) box = BRepAlgoAPI_Cut(box, cylinder({x, -1, 15}, {0, 1, 0}, 6, 62));
  return {box};
}

CadShape make_cone_tip() {
  const TopoDS_Shape cone = BRepPrimAPI_MakeCone(gp_Ax2({0, 0, 30}, {0, 0, 1}), 20, 0, 50).Shape();
  const TopoDS_Shape body = BRepAlgoAPI_Fuse(cone, cylinder({0, 0, 0}, {0, 0, 1}, 12, 35));
  return {BRepAlgoAPI_Cut(body, cylinder({-40, 0, 12}, {1, 0, 0}, 5, 80))};
}

CadShape make_cross_drilled() {
  TopoDS_Shape block = BRepPrimAPI_MakeBox(60, 50, 40).Shape();
  block = BRepAlgoAPI_Cut(block, cylinder({-1, 25, 20}, {1, 0, 0}, 9, 62));
  block = BRepAlgoAPI_Cut(block, cylinder({22, -1, 23}, {0, 1, 0}, 6, 52));
  block = BRepAlgoAPI_Cut(block, cylinder({45, 25, 15}, {0, 0.6, 0.8}, 4, 60));
  return {BRepAlgoAPI_Cut(block, BRepPrimAPI_MakeSphere(gp_Pnt(60, 50, 40), 15).Shape())};
}

CadShape make_fins() {
  constexpr int kFins = 9;
  TopoDS_Shape body = cylinder({0, 0, 0}, {0, 0, 1}, 10, 50);
  for (int k = 0; k < kFins; ++k) {
    const double angle = 2 * std::numbers::pi * k / kFins;
    const gp_Ax2 place({0, 0, 6.0 + k}, {0, 0, 1}, {std::cos(angle), std::sin(angle), 0});
    const gp_Pnt corner = gp_Pnt(place.Location()).Translated(-0.6 * gp_Vec(place.YDirection()));
    const gp_Ax2 fin(corner, place.Direction(), place.XDirection());
    body = BRepAlgoAPI_Fuse(body, BRepPrimAPI_MakeBox(fin, 26, 1.2, 34).Shape());
  }
  return {BRepAlgoAPI_Cut(body, cylinder({0, 0, -1}, {0, 0, 1}, 6, 52))};
}

}  // namespace delquad::cad
