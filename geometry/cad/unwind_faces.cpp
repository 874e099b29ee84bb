// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cad/heal_shape.h"

#include <fmt/format.h>

#include <BRepAdaptor_Surface.hxx>
#include <BRepTools.hxx>
#include <BRepTools_ReShape.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Precision.hxx>
#include <ShapeFix_Wire.hxx>
#include <TopAbs.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Iterator.hxx>

namespace delquad::cad {

namespace {

/// Returns whether the face's boundary extends over more than a period.
bool winds(const TopoDS_Face& face) {
  constexpr double kOnce = 1.01;
  const BRepAdaptor_Surface surface(face, /*R=*/false);
  double u0, u1, v0, v1;
  BRepTools::UVBounds(face, u0, u1, v0, v1);
  return (surface.IsUPeriodic() && u1 - u0 > kOnce * surface.UPeriod()) ||
         (surface.IsVPeriodic() && v1 - v0 > kOnce * surface.VPeriod());
}

/// Returns the reversed face, with the same edges, moved by periods so that each begins at the end of
/// another.
TopoDS_Face turned(const TopoDS_Face& face) {
  TopoDS_Face other = TopoDS::Face(face.EmptyCopied().Oriented(TopAbs_FORWARD));
  for (TopoDS_Iterator wire(face.Oriented(TopAbs_FORWARD)); wire.More(); wire.Next()) {
    ShapeFix_Wire fixer(TopoDS::Wire(wire.Value().Reversed()), other, Precision::Confusion());
    fixer.FixReorder();
    fixer.FixShifted();
    BRep_Builder().Add(other, fixer.Wire());
  }
  other.Orientation(TopAbs::Reverse(face.Orientation()));
  return other;
}

}  // namespace

void unwind_faces(CadShape& cad) {
  const TopTools_IndexedMapOfShape faces = parts(cad.shape, TopAbs_FACE);
  BRepTools_ReShape reshape;
  int n = 0;
  for (int f = 1; f <= faces.Extent(); ++f) {
    const TopoDS_Face face = TopoDS::Face(faces(f));
    if (!winds(face)) continue;
    const TopoDS_Face other = turned(face);
    if (winds(other)) continue;
    reshape.Replace(face, other);
    ++n;
  }
  if (n == 0) return;
  replace_shape(cad, reshape.Apply(cad.shape), [&](const TopoDS_Shape& part) { return reshape.Apply(part); });
  cad.warnings.push_back(fmt::format("{} face(s) went around more than once and have been turned over", n));
}

}  // namespace delquad::cad
