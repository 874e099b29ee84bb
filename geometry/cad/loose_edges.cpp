// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cad/heal_shape.h"

#include <fmt/format.h>

#include <BRepAdaptor_Curve.hxx>
#include <BRepLib.hxx>
#include <BRepTools_ReShape.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <GCPnts_TangentialDeflection.hxx>
#include <Geom_Curve.hxx>
#include <Precision.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_DataMapOfShapeInteger.hxx>
#include <TopTools_MapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Iterator.hxx>

namespace delquad::cad {

namespace {

/// Largest angle between neighboring chords, radians.
constexpr double kTurnOfChords = 0.1;

/// Returns the edges that bound faces or lie in several, and the ends of edges; edges inside of faces are
/// INTERNAL.
TopTools_MapOfShape joining_edges(const TopoDS_Shape& shape) {
  TopTools_MapOfShape joining;
  TopTools_DataMapOfShapeInteger inside_of;
  const TopTools_IndexedMapOfShape faces = parts(shape, TopAbs_FACE);
  for (int f = 1; f <= faces.Extent(); ++f)
    for (TopExp_Explorer at(faces(f).Oriented(TopAbs_FORWARD), TopAbs_EDGE); at.More(); at.Next()) {
      const TopoDS_Shape& edge = at.Current();
      for (TopExp_Explorer end(edge, TopAbs_VERTEX); end.More(); end.Next()) joining.Add(end.Current());
      const int* known = inside_of.Seek(edge);
      if (is_boundary(edge) || (known != nullptr && *known != f)) joining.Add(edge);
      if (known == nullptr) inside_of.Bind(edge, f);
    }
  return joining;
}

std::vector<Vec3> chords(const TopoDS_Edge& edge, double deflection) {
  const BRepAdaptor_Curve curve(edge);
  const GCPnts_TangentialDeflection cut(curve, kTurnOfChords, deflection);
  std::vector<Vec3> points;
  for (int i = 1; i <= cut.NbPoints(); ++i) points.push_back(vec_of(cut.Value(i)));
  return points;
}

bool is_finite_curve(const TopoDS_Edge& edge) {
  if (BRep_Tool::Degenerated(edge) || !BRepLib::BuildCurve3d(edge)) return false;
  double first, last;
  return !BRep_Tool::Curve(edge, first, last).IsNull() && !Precision::IsInfinite(first) &&
         !Precision::IsInfinite(last);
}

/// Returns the edges of a wire that bound its face or join it to others; null: none.
TopoDS_Shape joining_part(const TopoDS_Shape& wire, const TopTools_MapOfShape& joining) {
  bool has_others = false, is_empty = true;
  TopoDS_Shape part = wire.EmptyCopied();
  const TopAbs_Orientation side = wire.Orientation();
  part.Orientation(TopAbs_FORWARD);
  for (TopoDS_Iterator edge(wire.Oriented(TopAbs_FORWARD)); edge.More(); edge.Next()) {
    if (!joining.Contains(edge.Value())) {
      has_others = true;
      continue;
    }
    BRep_Builder().Add(part, edge.Value());
    is_empty = false;
  }
  if (is_empty || (side != TopAbs_FORWARD && side != TopAbs_REVERSED)) return {};
  part.Closed(wire.Closed());
  return has_others ? part.Oriented(side) : wire;
}

/// Returns the face without the edges that lie in no other face.
TopoDS_Shape without_inner_edges(const TopoDS_Shape& face, const TopTools_MapOfShape& joining) {
  const TopoDS_Shape outwards = face.Oriented(TopAbs_FORWARD);
  TopoDS_Shape other = outwards.EmptyCopied();
  bool changed = false;
  for (TopoDS_Iterator child(outwards); child.More(); child.Next()) {
    const TopoDS_Shape part = child.Value().ShapeType() == TopAbs_WIRE ? joining_part(child.Value(), joining)
                              : joining.Contains(child.Value())        ? child.Value()
                                                                       : TopoDS_Shape();
    changed = changed || part.IsNull() || !part.IsSame(child.Value());
    if (!part.IsNull()) BRep_Builder().Add(other, part);
  }
  return changed ? other.Oriented(face.Orientation()) : face;
}

}  // namespace

void drop_inner_edges(CadShape& cad) {
  const TopTools_IndexedMapOfShape faces = parts(cad.shape, TopAbs_FACE);
  const TopTools_MapOfShape joining = joining_edges(cad.shape);
  BRepTools_ReShape reshape;
  bool any = false;
  for (int f = 1; f <= faces.Extent(); ++f) {
    const TopoDS_Shape other = without_inner_edges(faces(f), joining);
    if (other.IsSame(faces(f))) continue;
    reshape.Replace(faces(f), other);
    any = true;
  }
  if (any)
    replace_shape(cad, reshape.Apply(cad.shape),
                  [&](const TopoDS_Shape& part) { return reshape.Apply(part); });
}

std::vector<LooseLine> loose_edges(const CadShape& cad, double deflection) {
  const TopoDS_Shape& shape = cad.shape;
  std::vector<LooseLine> loose;
  const TopTools_MapOfShape joining = joining_edges(shape);
  const TopTools_IndexedMapOfShape edges = parts(shape, TopAbs_EDGE);
  for (int e = 1; e <= edges.Extent(); ++e)
    if (const TopoDS_Edge edge = TopoDS::Edge(edges(e)); !joining.Contains(edge) && is_finite_curve(edge))
      loose.push_back({chords(edge, deflection), cad.names.of(edge), fmt::format("edge {}", e)});
  TopTools_IndexedMapOfShape vertices;
  for (TopExp_Explorer vertex(shape, TopAbs_VERTEX, TopAbs_EDGE); vertex.More(); vertex.Next())
    vertices.Add(vertex.Current());
  for (int v = 1; v <= vertices.Extent(); ++v)
    loose.push_back({{vec_of(BRep_Tool::Pnt(TopoDS::Vertex(vertices(v))))},
                     {},
                     fmt::format("the vertex without edges {}", v)});
  return loose;
}

}  // namespace delquad::cad
