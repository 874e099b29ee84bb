// SPDX-License-Identifier: GPL-3.0-or-later
#include <BRepAdaptor_Surface.hxx>
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepOffsetAPI_ThruSections.hxx>
#include <BRepPrimAPI_MakeRevol.hxx>
#include <Geom_BezierCurve.hxx>
#include <TColgp_Array1OfPnt.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <array>
#include <gp_Ax1.hxx>
#include <numbers>

#include "geometry/cad/examples/shapes.h"

namespace delquad::cad {

namespace {

template <std::size_t N>
TopoDS_Edge bezier(const std::array<gp_Pnt, N>& poles) {
  TColgp_Array1OfPnt array(1, static_cast<int>(N));
  for (std::size_t k = 0; k < N; ++k) array(static_cast<int>(k) + 1) = poles[k];
  return BRepBuilderAPI_MakeEdge(Handle(Geom_Curve)(new Geom_BezierCurve(array)));
}

/// Returns the left half (y > 0) of a body of revolution about x with a round nose and a round tail.
TopoDS_Shape half_fuselage() {
  constexpr double kBodyLength = 100;
  const TopoDS_Edge profile = bezier<7>({{{0, 0, 0},
                                          {0, 0, -5},
                                          {14, 0, -8},
                                          {50, 0, -8},
                                          {85, 0, -6},
                                          {kBodyLength, 0, -3},
                                          {kBodyLength, 0, 0}}});
  const TopoDS_Edge axis = BRepBuilderAPI_MakeEdge(gp_Pnt(kBodyLength, 0, 0), gp_Pnt(0, 0, 0));
  const TopoDS_Shape below = BRepBuilderAPI_MakeFace(BRepBuilderAPI_MakeWire(profile, axis).Wire());
  return BRepPrimAPI_MakeRevol(below, gp_Ax1({0, 0, 0}, {1, 0, 0}), std::numbers::pi);
}

/// Returns an airfoil section in a plane of constant y: 12 % thick, round in front, with a sharp trailing
/// edge.
TopoDS_Wire section(const gp_Pnt& leading_edge, double chord) {
  const auto side = [&](double up) {
    const auto at = [&](double x, double z) {
      return gp_Pnt(leading_edge.X() + x * chord, leading_edge.Y(), leading_edge.Z() + up * z * chord);
    };
    return bezier<4>({{at(0, 0), at(0, 0.08), at(0.35, 0.10), at(1, 0)}});
  };
  return BRepBuilderAPI_MakeWire(side(1), side(-1)).Wire();
}

/// Returns a wing from inside the fuselage to a tip at y = 50.
TopoDS_Shape wing() {
  BRepOffsetAPI_ThruSections loft(/*isSolid=*/true, /*ruled=*/true);
  loft.AddWire(section({30, 2, -1}, 30));
  loft.AddWire(section({52, 50, 3}, 12));
  return loft.Shape();
}

std::string part_of(const TopoDS_Face& face) {
  switch (BRepAdaptor_Surface(face).GetType()) {
    case GeomAbs_SurfaceOfRevolution:
      return "fuselage";
    case GeomAbs_Plane:
      return "tips";
    default:
      return "wing";
  }
}

}  // namespace

CadShape make_wing_body() {
  const TopoDS_Shape left = BRepAlgoAPI_Fuse(half_fuselage(), wing());
  gp_Trsf mirror;
  mirror.SetMirror(gp_Ax2({0, 0, 0}, {0, 1, 0}));
  CadShape cad{BRepAlgoAPI_Fuse(left, BRepBuilderAPI_Transform(left, mirror, /*Copy=*/true).Shape())};
  for (TopExp_Explorer face(cad.shape, TopAbs_FACE); face.More(); face.Next())
    cad.names.add(face.Current(), part_of(TopoDS::Face(face.Current())));
  return cad;
}

}  // namespace delquad::cad
