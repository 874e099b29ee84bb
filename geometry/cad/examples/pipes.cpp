// SPDX-License-Identifier: GPL-3.0-or-later
#include <BRepAdaptor_Curve.hxx>
#include <BRepAdaptor_Surface.hxx>
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepFilletAPI_MakeFillet.hxx>
#include <BRepOffsetAPI_MakePipe.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <GC_MakeArcOfCircle.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Shell.hxx>
#include <cmath>
#include <gp_Circ.hxx>

#include "geometry/cad/examples/shapes.h"

namespace delquad::cad {

namespace {

TopoDS_Wire circle(const gp_Ax2& place, double radius) {
  return BRepBuilderAPI_MakeWire(BRepBuilderAPI_MakeEdge(gp_Circ(place, radius))).Wire();
}

/// Returns a spine from the origin along x, around a quarter of a turn, and along y.
TopoDS_Wire elbow_spine(double before, double bend, double after) {
  const double s = bend * std::sqrt(0.5);
  const gp_Pnt a(0, 0, 0), b(before, 0, 0), middle(before + s, bend - s, 0), c(before + bend, bend, 0),
      d(before + bend, bend + after, 0);
  return BRepBuilderAPI_MakeWire(BRepBuilderAPI_MakeEdge(a, b),
                                 BRepBuilderAPI_MakeEdge(GC_MakeArcOfCircle(b, middle, c).Value()),
                                 BRepBuilderAPI_MakeEdge(c, d))
      .Wire();
}

/// Returns a main cylinder along x and a branch along z, with seams away from their common curve.
TopoDS_Shape cross_of(double length, double radius, double height, double branch_radius) {
  const gp_Ax2 along({-length / 2, 0, 0}, {1, 0, 0}, {0, 0, -1}), up({0, 0, 0}, {0, 0, 1}, {0, 1, 0});
  return BRepAlgoAPI_Fuse(BRepPrimAPI_MakeCylinder(along, radius, length),
                          BRepPrimAPI_MakeCylinder(up, branch_radius, height));
}

/// Rounds the edges between two cylinders, which are neither circles nor lines.
TopoDS_Shape rounded_crossing(const TopoDS_Shape& sharp, double radius) {
  BRepFilletAPI_MakeFillet fillet(sharp);
  for (TopExp_Explorer edge(sharp, TopAbs_EDGE); edge.More(); edge.Next()) {
    const TopoDS_Edge& e = TopoDS::Edge(edge.Current());
    const GeomAbs_CurveType type = BRepAdaptor_Curve(e).GetType();
    if (type != GeomAbs_Circle && type != GeomAbs_Line) fillet.Add(radius, e);
  }
  return fillet.Shape();
}

}  // namespace

CadShape make_pipe_tee() {
  constexpr double kRadius = 20, kBranchRadius = 15;
  const TopoDS_Shape solid = cross_of(120, kRadius, 60, kBranchRadius);
  TopoDS_Shell shell;
  BRep_Builder builder;
  builder.MakeShell(shell);
  CadShape cad;
  for (TopExp_Explorer face(solid, TopAbs_FACE); face.More(); face.Next()) {
    const BRepAdaptor_Surface surface(TopoDS::Face(face.Current()));
    if (surface.GetType() != GeomAbs_Cylinder) continue;  // the lid of an end
    builder.Add(shell, face.Current());
    cad.names.add(face.Current(), surface.Cylinder().Radius() < kRadius ? "branch" : "pipe");
  }
  cad.shape = shell;
  return cad;
}

CadShape make_elbow() {
  constexpr double kOuter = 10, kInner = 7;
  const gp_Ax2 place({0, 0, 0}, {1, 0, 0}, {0, 0, 1});
  BRepBuilderAPI_MakeFace ring(circle(place, kOuter));
  ring.Add(TopoDS::Wire(circle(place, kInner).Reversed()));
  return {BRepOffsetAPI_MakePipe(elbow_spine(30, 25, 20), ring.Face()).Shape()};
}

CadShape make_blended_tee() {
  const TopoDS_Shape outside = rounded_crossing(cross_of(120, 20, 60, 14), 6);
  return {BRepAlgoAPI_Cut(outside, cross_of(122, 16, 61, 10))};
}

}  // namespace delquad::cad
