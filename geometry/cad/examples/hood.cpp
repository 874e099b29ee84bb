// SPDX-License-Identifier: GPL-3.0-or-later
#include <BRepAlgoAPI_BuilderAlgo.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeVertex.hxx>
#include <BRepBuilderAPI_Sewing.hxx>
#include <GeomConvert_BSplineSurfaceToBezierSurface.hxx>
#include <Geom_BSplineSurface.hxx>
#include <Geom_BezierSurface.hxx>
#include <Precision.hxx>
#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TColgp_Array2OfPnt.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_ListOfShape.hxx>
#include <algorithm>
#include <cmath>

#include "geometry/cad/examples/shapes.h"

namespace delquad::cad {

namespace {

constexpr int kDegree = 3;
constexpr int kAlong = 3, kAcross = 6;  // Bezier patches
constexpr double kSliver = 1.2;         // length of the outline's slivers; the outline is 4600 long

/// Returns the control point at s along (0: front edge, 1: windscreen) and t across (-1: right side, 1: left
/// side).
gp_Pnt control_point(double s, double t) {
  const double x = 1000 * s + 110 * t * t * (1 - s) - 40 * t * t * s;
  const double y = t * (610 + 90 * s);
  const double fall = 130 * (1 - s) * (1 - s) + 60 * t * t + 20 * t * t * t * t;
  const double bulge = 28 * std::exp(-std::pow(t / 0.4, 2)) * s;
  return {x, y, 200 - fall + bulge};
}

/// Returns the Greville abscissa, in [0, 1], of control point k of a spline with `spans` equal pieces.
double greville(int k, int spans) {
  double sum = 0;
  for (int j = 1; j <= kDegree; ++j) sum += std::clamp(k + j - kDegree, 0, spans);
  return sum / (kDegree * spans);
}

/// Returns the surface, twice differentiable, in kAlong x kAcross pieces.
Handle(Geom_BSplineSurface) whole_surface() {
  TColgp_Array2OfPnt poles(1, kAlong + kDegree, 1, kAcross + kDegree);
  for (int i = 1; i <= poles.ColLength(); ++i)
    for (int j = 1; j <= poles.RowLength(); ++j)
      poles(i, j) = control_point(greville(i - 1, kAlong), 2 * greville(j - 1, kAcross) - 1);
  const auto knots = [](int spans) {
    TColStd_Array1OfReal values(1, spans + 1);
    for (int k = 0; k <= spans; ++k) values(k + 1) = static_cast<double>(k) / spans;
    return values;
  };
  const auto multiplicities = [](int spans) {
    TColStd_Array1OfInteger times(1, spans + 1);
    times.Init(1);
    times(1) = times(spans + 1) = kDegree + 1;
    return times;
  };
  return new Geom_BSplineSurface(poles, knots(kAlong), knots(kAcross), multiplicities(kAlong),
                                 multiplicities(kAcross), kDegree, kDegree);
}

/// Returns the vertex on the windscreen's edge, a sliver's length beside the joint of patches at parameter v.
TopoDS_Shape sliver_end(const Handle(Geom_BSplineSurface) & surface, double v) {
  gp_Pnt at;
  gp_Vec along_u, along_v;
  surface->D1(1, v, at, along_u, along_v);
  const double step = kSliver / along_v.Magnitude();
  return BRepBuilderAPI_MakeVertex(surface->Value(1, v < 0.5 ? v - step : v + step)).Shape();
}

}  // namespace

CadShape make_hood() {
  const Handle(Geom_BSplineSurface) surface = whole_surface();
  GeomConvert_BSplineSurfaceToBezierSurface pieces(surface);
  TopTools_ListOfShape parts;
  for (int i = 1; i <= pieces.NbUPatches(); ++i)
    for (int j = 1; j <= pieces.NbVPatches(); ++j)
      parts.Append(BRepBuilderAPI_MakeFace(pieces.Patch(i, j), Precision::Confusion()).Shape());
  for (const int j : {1, kAcross - 1}) parts.Append(sliver_end(surface, static_cast<double>(j) / kAcross));
  // Merges coincident edges and cuts them at the vertices.
  BRepAlgoAPI_BuilderAlgo join;
  join.SetArguments(parts);
  join.Build();
  BRepBuilderAPI_Sewing shell;
  for (TopExp_Explorer face(join.Shape(), TopAbs_FACE); face.More(); face.Next()) shell.Add(face.Current());
  shell.Perform();
  return {shell.SewedShape()};
}

}  // namespace delquad::cad
