// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cad/heal_shape.h"

#include <fmt/format.h>

#include <BOPAlgo_Builder.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Message_Report.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>

#include "base/disjoint_sets.h"
#include "base/parallel.h"
#include "base/text.h"
#include "delquad/error.h"
#include "geometry/cad/tessellate.h"

namespace delquad::cad {

namespace {

/// Returns the kernel's first complaint, such as " (BOPAlgo_AlertTooFewArguments)".
std::string why(const BOPAlgo_Builder& builder) {
  const Message_ListOfAlert& failures = builder.GetReport()->GetAlerts(Message_Fail);
  return failures.IsEmpty() ? "" : fmt::format(" ({})", failures.First()->GetMessageKey());
}

/// Returns the image of a face or an edge as a compound: itself, its parts, or nothing.
TopoDS_Compound image_of(BOPAlgo_Builder& builder, const TopoDS_Shape& part) {
  TopoDS_Compound image = empty_compound();
  const TopTools_ListOfShape& modified = builder.Modified(part);
  for (const TopoDS_Shape& each : modified) BRep_Builder().Add(image, each);
  if (modified.IsEmpty() && !builder.IsDeleted(part)) BRep_Builder().Add(image, part);
  return image;
}

/// Returns the parts to glue: solids, closed shells, and the faces of open shells, which may touch each
/// other.
TopTools_ListOfShape glued_parts(const TopoDS_Shape& shape) {
  TopTools_ListOfShape all;
  for (const TopoDS_Shape& body : bodies_of(shape)) {
    if (body.ShapeType() != TopAbs_SHELL || BRep_Tool::IsClosed(body)) {
      all.Append(body);
      continue;
    }
    for (TopExp_Explorer face(body, TopAbs_FACE); face.More(); face.Next()) all.Append(face.Current());
  }
  return all;
}

/// Returns the images of the faces of some bodies.
TopTools_ListOfShape images_of_bodies(BOPAlgo_Builder& builder, const TopTools_ListOfShape& bodies) {
  TopTools_ListOfShape all;
  for (const TopoDS_Shape& body : bodies) {
    TopoDS_Compound images = empty_compound();
    for (TopExp_Explorer face(body, TopAbs_FACE); face.More(); face.Next())
      BRep_Builder().Add(images, image_of(builder, face.Current()));
    all.Append(images);
  }
  return all;
}

/// Returns the number of faces, edges or vertices that several bodies share, before and after; degenerate
/// edges do not count.
int count_common(const TopTools_ListOfShape& before, const TopTools_ListOfShape& after,
                 TopAbs_ShapeEnum kind) {
  TopTools_IndexedMapOfShape common;
  for (const TopTools_ListOfShape& bodies : {before, after}) {
    TopTools_IndexedMapOfShape seen;
    for (const TopoDS_Shape& body : bodies) {
      const TopTools_IndexedMapOfShape own = parts(body, kind);
      for (int i = 1; i <= own.Extent(); ++i) {
        if (kind == TopAbs_EDGE && BRep_Tool::Degenerated(TopoDS::Edge(own(i)))) continue;
        const int known = seen.Extent();
        if (seen.Add(own(i)) <= known) common.Add(own(i));
      }
    }
  }
  return common.Extent();
}

/// Returns the number of parts that no edges connect.
int count_parts(const TopoDS_Shape& shape) {
  TopTools_IndexedDataMapOfShapeListOfShape faces_of;
  TopExp::MapShapesAndAncestors(shape, TopAbs_EDGE, TopAbs_FACE, faces_of);
  const TopTools_IndexedMapOfShape faces = parts(shape, TopAbs_FACE);
  DisjointSets joined(faces.Extent());
  int n = faces.Extent();
  for (int e = 1; e <= faces_of.Extent(); ++e)
    for (const TopoDS_Shape& face : faces_of(e))
      n -= joined.join(faces.FindIndex(faces_of(e).First()) - 1, faces.FindIndex(face) - 1);
  return n;
}

/// Returns texts such as "face 3 (lid) into 2" for the faces that were cut.
std::vector<std::string> cut_faces(BOPAlgo_Builder& builder, const CadShape& cad) {
  const TopTools_IndexedMapOfShape faces = parts(cad.shape, TopAbs_FACE);
  std::vector<std::string> cut;
  for (int f = 1; f <= faces.Extent(); ++f)
    if (const int n = parts(image_of(builder, faces(f)), TopAbs_FACE).Extent(); n > 1)
      cut.push_back(fmt::format("{} into {}", face_title(f, cad.names.of(faces(f))), n));
  return cut;
}

}  // namespace

void glue_shape(CadShape& cad, double tolerance) {
  constexpr std::size_t kMostNamed = 20;
  const TopTools_ListOfShape bodies = glued_parts(cad.shape);
  if (bodies.Extent() < 2) {
    cad.warnings.push_back("nothing to glue: the model is one body");
    return;
  }
  BOPAlgo_Builder builder;
  for (const TopoDS_Shape& body : bodies) builder.AddArgument(body);
  builder.SetFuzzyValue(tolerance);
  builder.SetNonDestructive(true);
  builder.SetRunParallel(thread_count() > 1);
  builder.Perform();
  if (builder.HasErrors() || builder.Shape().IsNull())
    throw InputError("its bodies cannot be glued" + why(builder) + " [not-glued]");
  const TopoDS_Shape glued = builder.Shape();
  const int n_before = parts(cad.shape, TopAbs_SOLID).Extent(), n_after = parts(glued, TopAbs_SOLID).Extent();
  if (n_after < n_before)
    throw InputError(fmt::format("its bodies cannot be glued: of {} solids {} would be left [not-glued]",
                                 n_before, n_after));
  const std::vector<std::string> cut = cut_faces(builder, cad);
  replace_shape(cad, glued, [&](const TopoDS_Shape& part) { return image_of(builder, part); });
  const auto count = [&, before = images_of_bodies(builder, bodies), after = glued_parts(glued)](
                         TopAbs_ShapeEnum kind) { return count_common(before, after, kind); };
  const int n_parts = count_parts(glued);
  cad.warnings.push_back(
      fmt::format("glued: {} bodies have {} faces, {} edges and {} vertices in common{}", bodies.Extent(),
                  count(TopAbs_FACE), count(TopAbs_EDGE), count(TopAbs_VERTEX),
                  n_parts > 1 ? fmt::format("; {} parts hang apart, without a common edge", n_parts) : ""));
  if (!cut.empty())
    cad.warnings.push_back(fmt::format(
        "glued: faces cut where others lie on them, by their numbers before: {}", first_of(cut, kMostNamed)));
  if (n_after > n_before)
    cad.warnings.push_back(fmt::format(
        "glued: solids overlap or touch themselves: {} solids became {} that do not", n_before, n_after));
}

}  // namespace delquad::cad
