// SPDX-License-Identifier: GPL-3.0-or-later
#include <BRepAdaptor_Surface.hxx>
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepFilletAPI_MakeFillet.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <BRep_Tool.hxx>
#include <GC_MakeArcOfCircle.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <array>
#include <cmath>
#include <numbers>

#include "geometry/cad/examples/shapes.h"

namespace delquad::cad {

namespace {

constexpr double kLength = 80, kWidth = 60, kHeight = 66, kThickness = 8;
constexpr double kBend = 8;  // inner radius; the outer arc has the same axis
constexpr double kFootCorner = 10, kTopCorner = 15;
constexpr double kBossRadius = 15, kBossEnd = 16, kBossHeight = 40, kBossFillet = 3;
constexpr double kBoreRadius = 9, kHoleRadius = 4;
constexpr double kHoleFromSide = 12;
constexpr std::array<double, 2> kHolesAt = {30, 64};

/// Returns an L-shaped plate of constant thickness with a round bend, extruded along y.
TopoDS_Shape bent_plate() {
  const double axis = kThickness + kBend, r = kBend * std::numbers::sqrt2 / 2,
               far = axis * std::numbers::sqrt2 / 2;
  const auto at = [](double x, double z) { return gp_Pnt(x, 0, z); };
  BRepBuilderAPI_MakeWire outline;
  const auto line = [&](const gp_Pnt& a, const gp_Pnt& b) { outline.Add(BRepBuilderAPI_MakeEdge(a, b)); };
  const auto arc = [&](const gp_Pnt& a, const gp_Pnt& through, const gp_Pnt& b) {
    outline.Add(BRepBuilderAPI_MakeEdge(GC_MakeArcOfCircle(a, through, b).Value()));
  };
  line(at(axis, 0), at(kLength, 0));
  line(at(kLength, 0), at(kLength, kThickness));
  line(at(kLength, kThickness), at(axis, kThickness));
  arc(at(axis, kThickness), at(axis - r, axis - r), at(kThickness, axis));
  line(at(kThickness, axis), at(kThickness, kHeight));
  line(at(kThickness, kHeight), at(0, kHeight));
  line(at(0, kHeight), at(0, axis));
  arc(at(0, axis), at(axis - far, axis - far), at(axis, 0));
  return BRepPrimAPI_MakePrism(BRepBuilderAPI_MakeFace(outline.Wire()), gp_Vec(0, kWidth, 0));
}

/// Returns whether an edge lies in the plane x, y or z (0, 1, 2) = value.
bool lies_in(const TopoDS_Edge& edge, int direction, double value) {
  for (const TopoDS_Vertex& v : {TopExp::FirstVertex(edge), TopExp::LastVertex(edge)})
    if (std::abs(BRep_Tool::Pnt(v).Coord(direction + 1) - value) > 1e-9) return false;
  return true;
}

TopoDS_Shape with_fillets(const TopoDS_Shape& sharp) {
  const TopTools_IndexedMapOfShape edges = parts(sharp, TopAbs_EDGE);
  BRepFilletAPI_MakeFillet fillet(sharp);
  for (int e = 1; e <= edges.Extent(); ++e) {
    const TopoDS_Edge edge = TopoDS::Edge(edges(e));
    const bool on_side = lies_in(edge, 1, 0) || lies_in(edge, 1, kWidth);
    const bool is_loop = TopExp::FirstVertex(edge).IsSame(TopExp::LastVertex(edge));
    if (on_side && lies_in(edge, 0, kLength)) fillet.Add(kFootCorner, edge);
    if (on_side && lies_in(edge, 2, kHeight)) fillet.Add(kTopCorner, edge);
    if (is_loop && lies_in(edge, 0, kThickness)) fillet.Add(kBossFillet, edge);
  }
  return fillet.Shape();
}

std::string role_of(const TopoDS_Face& face) {
  const BRepAdaptor_Surface surface(face);
  if (surface.GetType() == GeomAbs_Cylinder) {
    const double radius = surface.Cylinder().Radius();
    if (radius == kHoleRadius) return "holes";
    if (radius == kBoreRadius) return "bore";
  }
  if (surface.GetType() == GeomAbs_Plane && std::abs(surface.Plane().Axis().Direction().Z()) > 0.5 &&
      std::abs(surface.Plane().Location().Z()) < 1e-9)
    return "base";
  return "body";
}

}  // namespace

CadShape make_bracket() {
  const auto cylinder = [](const gp_Pnt& from, const gp_Dir& along, double radius, double length) {
    return BRepPrimAPI_MakeCylinder(gp_Ax2(from, along), radius, length).Shape();
  };
  const gp_Dir x(1, 0, 0), z(0, 0, 1);
  TopoDS_Shape solid = BRepAlgoAPI_Fuse(bent_plate(), cylinder({0.5 * kThickness, kWidth / 2, kBossHeight}, x,
                                                               kBossRadius, kBossEnd - 0.5 * kThickness));
  solid = with_fillets(solid);
  solid = BRepAlgoAPI_Cut(solid, cylinder({-1, kWidth / 2, kBossHeight}, x, kBoreRadius, kBossEnd + 2));
  for (const double at : kHolesAt)
    for (const double side : {kHoleFromSide, kWidth - kHoleFromSide})
      solid = BRepAlgoAPI_Cut(solid, cylinder({at, side, -1}, z, kHoleRadius, kThickness + 2));
  CadShape cad{solid};
  for (TopExp_Explorer face(solid, TopAbs_FACE); face.More(); face.Next())
    cad.names.add(face.Current(), role_of(TopoDS::Face(face.Current())));
  return cad;
}

}  // namespace delquad::cad
