#include "geometry/cad/heal_shape.h"

#include <fmt/format.h>

#include <BRepBuilderAPI_Sewing.hxx>
#include <BRepCheck_Analyzer.hxx>
#include <BRepTools.hxx>
#include <BRepTools_ReShape.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <ShapeBuild_ReShape.hxx>
#include <ShapeFix_Shape.hxx>
#include <TopExp.hxx>
#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>

#include "base/parallel.h"
#include "geometry/cad/glue_shape.h"
#include "geometry/cad/sub_shapes.h"

namespace delquad::cad {

namespace {

int count_free_edges(const TopoDS_Shape& shape) {
  TopTools_IndexedDataMapOfShapeListOfShape faces_of;
  TopExp::MapShapesAndAncestors(shape, TopAbs_EDGE, TopAbs_FACE, faces_of);
  int n = 0;
  for (int e = 1; e <= faces_of.Extent(); ++e)
    n += faces_of(e).Extent() == 1 && !BRep_Tool::Degenerated(TopoDS::Edge(faces_of.FindKey(e)));
  return n;
}

/// Puts `shape` in the place of the CAD's; `image` tells what has become of a face or an edge.
template <class Image>
void replace(CadShape& cad, const TopoDS_Shape& shape, Image image) {
  PartNames names;
  for (const TopAbs_ShapeEnum kind : {TopAbs_FACE, TopAbs_EDGE}) {
    const TopTools_IndexedMapOfShape all = parts(cad.shape, kind);
    for (int p = 1; p <= all.Extent(); ++p) {
      const std::vector<std::string> own = cad.names.of(all(p));
      if (own.empty()) continue;
      const TopTools_IndexedMapOfShape images = parts(image(all(p)), kind);
      for (const std::string& name : own)
        for (int i = 1; i <= images.Extent(); ++i) names.add(images(i), name);
    }
  }
  cad.shape = shape;
  cad.names = names;
}

BRepCheck_Analyzer check_shape(const TopoDS_Shape& shape) {
  return BRepCheck_Analyzer(shape, /*GeomControls=*/true, /*theIsParallel=*/thread_count() > 1);
}

void fix(CadShape& cad) {
  if (check_shape(cad.shape).IsValid()) return;
  ShapeFix_Shape fixer(cad.shape);
  fixer.Perform();
  const TopoDS_Shape fixed = fixer.Shape();
  const BRepCheck_Analyzer check = check_shape(fixed);
  replace(cad, fixed, [&](const TopoDS_Shape& part) { return fixer.Context()->Apply(part); });
  if (check.IsValid()) {
    cad.warnings.push_back("the shape was invalid and has been healed");
    return;
  }
  TopTools_IndexedMapOfShape faces;
  TopExp::MapShapes(fixed, TopAbs_FACE, faces);
  std::string invalid;
  for (int f = 1; f <= faces.Extent(); ++f)
    if (!check.IsValid(faces(f))) invalid += fmt::format("{}{}", invalid.empty() ? ": faces " : ", ", f);
  cad.warnings.push_back("the shape is invalid and could be healed in part only" + invalid);
}

bool sew_branches(CadShape& cad, double tolerance) {
  TopoDS_Compound open, all;
  const BRep_Builder builder;
  builder.MakeCompound(open);
  builder.MakeCompound(all);
  for (const TopoDS_Shape& body : bodies_of(cad.shape)) {
    const bool is_closed =
        body.ShapeType() == TopAbs_SOLID || (body.ShapeType() == TopAbs_SHELL && BRep_Tool::IsClosed(body));
    builder.Add(is_closed ? all : open, body);
  }
  BRepBuilderAPI_Sewing sewing(tolerance, /*option1=*/true, /*option2=*/true, /*option3=*/true,
                               /*option4=*/true);
  sewing.Add(open);
  sewing.Perform();
  const TopoDS_Shape sewn = sewing.SewedShape();
  if (sewn.IsNull() || parts(sewn, TopAbs_EDGE).Extent() >= parts(open, TopAbs_EDGE).Extent()) return false;
  builder.Add(all, sewn);
  replace(cad, all, [&](const TopoDS_Shape& part) { return sewing.ModifiedSubShape(part); });
  return true;
}

/// Sews free edges in pairs; where that leaves any, those of what is open once more, all that coincide
/// together: edges of three faces and more. Parts that are closed stay apart from others.
void sew(CadShape& cad, double tolerance) {
  const int before = count_free_edges(cad.shape);
  if (before == 0) return;
  BRepBuilderAPI_Sewing in_pairs(tolerance);
  in_pairs.Add(cad.shape);
  in_pairs.Perform();
  bool any = false;
  if (const TopoDS_Shape sewn = in_pairs.SewedShape(); !sewn.IsNull() && count_free_edges(sewn) < before) {
    replace(cad, sewn, [&](const TopoDS_Shape& part) { return in_pairs.ModifiedSubShape(part); });
    any = true;
  }
  any = sew_branches(cad, tolerance) || any;
  if (any)
    cad.warnings.push_back(fmt::format("{} of {} free edges coincided and have been sewn",
                                       before - count_free_edges(cad.shape), before));
}

}  // namespace

void heal_shape(CadShape& cad, double tolerance) {
  // A file may carry an old triangulation, coarser than asked or of another shape.
  BRepTools::Clean(cad.shape);
  fix(cad);
  sew(cad, tolerance);
}

}  // namespace delquad::cad
