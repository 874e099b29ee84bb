// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cad/heal_shape.h"

#include <fmt/format.h>

#include <BOPTools_AlgoTools.hxx>
#include <BRepAdaptor_Curve.hxx>
#include <BRepBuilderAPI_MakeVertex.hxx>
#include <BRepBuilderAPI_Sewing.hxx>
#include <BRepCheck_Analyzer.hxx>
#include <BRepExtrema_DistShapeShape.hxx>
#include <BRepTools.hxx>
#include <BRepTools_ReShape.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <IntTools_Context.hxx>
#include <ShapeBuild_ReShape.hxx>
#include <ShapeFix_Shape.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Vertex.hxx>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>

#include "base/disjoint_sets.h"
#include "base/parallel.h"

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

/// Returns for each edge, after coinciding ones are joined, how often each face (number in `faces`) has it.
std::vector<std::map<int, int>> faces_at_edges(const TopoDS_Shape& shape,
                                               const TopTools_IndexedMapOfShape& faces, double tolerance) {
  BRepBuilderAPI_Sewing sewing(tolerance, /*option1=*/true, /*option2=*/true, /*option3=*/true,
                               /*option4=*/true);
  sewing.Add(shape);
  sewing.Perform();
  TopTools_IndexedMapOfShape edges;
  std::vector<std::map<int, int>> faces_of;
  for (int f = 1; f <= faces.Extent(); ++f)
    for (TopExp_Explorer edge(sewing.ModifiedSubShape(faces(f)), TopAbs_EDGE); edge.More(); edge.Next()) {
      if (BRep_Tool::Degenerated(TopoDS::Edge(edge.Current()))) continue;
      const auto at = static_cast<std::size_t>(edges.Add(edge.Current()));
      faces_of.resize(std::max(faces_of.size(), at));
      ++faces_of[at - 1][f];
    }
  return faces_of;
}

/// Returns for each face the first face that runs along the same edges and lies on it, mostly itself.
std::vector<int> first_of_doubles(const std::vector<std::map<int, int>>& faces_at_edges,
                                  const TopTools_IndexedMapOfShape& faces, double tolerance) {
  std::vector<std::vector<int>> edges_of(static_cast<std::size_t>(faces.Extent()) + 1);
  for (std::size_t e = 0; e < faces_at_edges.size(); ++e)
    for (const auto& [f, n] : faces_at_edges[e]) edges_of[f].push_back(static_cast<int>(e));
  const Handle(IntTools_Context) context = new IntTools_Context;
  std::map<std::vector<int>, std::vector<int>> firsts;
  std::vector<int> first(edges_of.size());
  for (int f = 1; f <= faces.Extent(); ++f) {
    std::vector<int>& known = firsts[edges_of[f]];
    const auto at = std::ranges::find_if(known, [&](int g) {
      return !edges_of[f].empty() && BOPTools_AlgoTools::AreFacesSameDomain(
                                         TopoDS::Face(faces(f)), TopoDS::Face(faces(g)), context, tolerance);
    });
    first[f] = at == known.end() ? f : *at;
    if (first[f] == f) known.push_back(f);
  }
  return first;
}

/// Finds closed bodies among faces without body, and gives each face the number of one face of its body. Two
/// faces at an edge belong together. If more faces meet there, consecutive pairs belong together if
/// `in_order`, as in files that list one body after the other. Faces on each other enclose nothing.
void find_closed(const std::vector<std::map<int, int>>& faces_at_edges, const std::vector<int>& first,
                 bool in_order, std::vector<int>& body) {
  DisjointSets joined(body.size());
  std::vector<std::vector<int>> free(faces_at_edges.size());  // faces at each edge without body
  for (std::size_t e = 0; e < free.size(); ++e) {
    for (const auto& [f, n] : faces_at_edges[e])
      if (body[f] == 0 && n == 1) free[e].push_back(f);
    if (free[e].size() == 2 || (in_order && free[e].size() % 2 == 0))
      for (std::size_t k = 0; k < free[e].size(); k += 2)
        if (first[free[e][k]] != first[free[e][k + 1]]) joined.join_to(free[e][k], free[e][k + 1]);
  }
  std::vector<char> is_open(body.size(), 0);
  for (const std::vector<int>& faces : free) {
    std::map<int, int> n_of_part;
    for (const int f : faces) ++n_of_part[joined.root(f)];
    for (const auto& [p, n] : n_of_part)
      if (n != 2) is_open[p] = 1;
  }
  for (std::size_t f = 1; f < body.size(); ++f)
    if (const int p = joined.root(static_cast<int>(f)); body[f] == 0 && !is_open[p]) body[f] = p;
}

/// Sews closed bodies one by one if edges of more than two faces coincide, so that bodies that touch stay
/// apart. Removes and returns faces of no closed body that lie on others, as they would enclose nothing.
TopTools_ListOfShape sew_bodies(CadShape& cad, double tolerance) {
  TopTools_IndexedMapOfShape faces;
  const BRep_Builder builder;
  TopoDS_Compound all = empty_compound(), open = empty_compound();
  for (const TopoDS_Shape& shape : bodies_of(cad.shape)) {
    const bool is_open = count_free_edges(shape) > 0;
    builder.Add(is_open ? open : all, shape);
    if (is_open) TopExp::MapShapes(shape, TopAbs_FACE, faces);
  }
  if (faces.IsEmpty()) return {};
  const auto at_edges = faces_at_edges(open, faces, tolerance);
  const std::vector<int> first_at = first_of_doubles(at_edges, faces, tolerance);
  std::vector<int> body(first_at.size(), 0);
  if (std::ranges::any_of(at_edges, [](const auto& of) { return of.size() > 2; }))
    for (const bool in_order : {true, false}) find_closed(at_edges, first_at, in_order, body);
  std::map<int, Handle(BRepBuilderAPI_Sewing)> sewings;
  std::set<int> known;
  TopTools_ListOfShape doubles;
  for (int f = 1; f <= faces.Extent(); ++f) {
    if (body[f] == 0) {
      if (known.insert(first_at[f]).second)
        builder.Add(all, faces(f));
      else
        doubles.Append(faces(f));
      continue;
    }
    Handle(BRepBuilderAPI_Sewing)& sewing = sewings[body[f]];
    if (sewing.IsNull()) sewing = new BRepBuilderAPI_Sewing(tolerance);
    sewing->Add(faces(f));
  }
  if (sewings.empty() && doubles.IsEmpty()) return {};
  for (const auto& [first, sewing] : sewings) {
    sewing->Perform();
    builder.Add(all, sewing->SewedShape());
  }
  replace_shape(cad, all, [&](const TopoDS_Shape& shape) {
    for (const auto& [first, sewing] : sewings)
      if (sewing->IsModifiedSubShape(shape)) return sewing->ModifiedSubShape(shape);
    return shape;
  });
  if (!sewings.empty())
    cad.warnings.push_back(fmt::format(
        "free edges coincided: closed bodies that touch were sewn one by one: {}", sewings.size()));
  return doubles;
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
  replace_shape(cad, fixed, [&](const TopoDS_Shape& part) { return fixer.Context()->Apply(part); });
  if (check.IsValid()) {
    cad.warnings.push_back("the shape was invalid and has been healed [healed-shape]");
    return;
  }
  const TopTools_IndexedMapOfShape faces = parts(fixed, TopAbs_FACE);
  std::string invalid;
  for (int f = 1; f <= faces.Extent(); ++f)
    if (!check.IsValid(faces(f))) invalid += fmt::format("{}{}", invalid.empty() ? ": faces " : ", ", f);
  cad.warnings.push_back("the shape is invalid and could be healed in part only" + invalid +
                         " [healed-shape]");
}

/// Returns whether sewing kept all faces; it drops very small ones.
bool keeps_faces(const TopoDS_Shape& sewn, const TopoDS_Shape& before) {
  return !sewn.IsNull() && parts(sewn, TopAbs_FACE).Extent() == parts(before, TopAbs_FACE).Extent();
}

bool sew_branches(CadShape& cad, double tolerance) {
  const BRep_Builder builder;
  TopoDS_Compound open = empty_compound(), all = empty_compound();
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
  if (!keeps_faces(sewn, open) || parts(sewn, TopAbs_EDGE).Extent() >= parts(open, TopAbs_EDGE).Extent())
    return false;
  builder.Add(all, sewn);
  replace_shape(cad, all, [&](const TopoDS_Shape& part) { return sewing.ModifiedSubShape(part); });
  return true;
}

/// Sews free edges in pairs. Then sews the open rest again, so that edges of three faces and more are joined;
/// closed parts stay apart.
void sew(CadShape& cad, double tolerance) {
  const int before = count_free_edges(cad.shape);
  if (before == 0) return;
  BRepBuilderAPI_Sewing in_pairs(tolerance);
  in_pairs.Add(cad.shape);
  in_pairs.Perform();
  bool any = false;
  if (const TopoDS_Shape sewn = in_pairs.SewedShape();
      keeps_faces(sewn, cad.shape) && count_free_edges(sewn) < before) {
    replace_shape(cad, sewn, [&](const TopoDS_Shape& part) { return in_pairs.ModifiedSubShape(part); });
    any = true;
  }
  any = sew_branches(cad, tolerance) || any;
  if (any)
    cad.warnings.push_back(fmt::format("{} of {} free edges coincided and have been sewn",
                                       before - count_free_edges(cad.shape), before));
}

/// Returns the largest tolerance of an edge and its ends.
double tolerance_of(const TopoDS_Edge& edge) {
  double tolerance = BRep_Tool::Tolerance(edge);
  for (const TopoDS_Vertex& end : {TopExp::FirstVertex(edge), TopExp::LastVertex(edge)})
    if (!end.IsNull()) tolerance = std::max(tolerance, BRep_Tool::Tolerance(end));
  return tolerance;
}

bool has_neighbour(const TopoDS_Shape& face, const TopTools_IndexedDataMapOfShapeListOfShape& faces_of) {
  for (TopExp_Explorer edge(face, TopAbs_EDGE); edge.More(); edge.Next())
    for (const TopoDS_Shape& other : faces_of.FindFromKey(edge.Current()))
      if (!other.IsSame(face)) return true;
  return false;
}

/// Returns the distance between the edges of a face (a length) if each lies on others everywhere.
std::optional<double> strip_width(const TopoDS_Face& face) {
  constexpr int kSamples = 8;  // samples of an edge
  const TopTools_IndexedMapOfShape edges = parts(face, TopAbs_EDGE);
  double width = 0;
  for (int e = 1; e <= edges.Extent(); ++e) {
    const TopoDS_Edge edge = TopoDS::Edge(edges(e));
    if (BRep_Tool::Degenerated(edge)) continue;
    const BRepAdaptor_Curve curve(edge);
    for (int k = 0; k <= kSamples; ++k) {
      const double part = static_cast<double>(k) / kSamples;
      const TopoDS_Vertex at = BRepBuilderAPI_MakeVertex(
          curve.Value((1 - part) * curve.FirstParameter() + part * curve.LastParameter()));
      double nearest = std::numeric_limits<double>::infinity();
      for (int d = 1; d <= edges.Extent(); ++d) {
        const TopoDS_Edge other = TopoDS::Edge(edges(d));
        if (d == e || BRep_Tool::Degenerated(other)) continue;
        const double distance = BRepExtrema_DistShapeShape(at, other).Value();
        if (distance <= tolerance_of(edge) + tolerance_of(other)) nearest = std::min(nearest, distance);
      }
      if (std::isinf(nearest)) return std::nullopt;
      width = std::max(width, nearest);
    }
  }
  return width;
}

}  // namespace

void replace_shape(CadShape& cad, const TopoDS_Shape& shape,
                   const std::function<TopoDS_Shape(const TopoDS_Shape&)>& image) {
  PartNames names;
  for (const TopAbs_ShapeEnum kind : {TopAbs_FACE, TopAbs_EDGE}) {
    const TopTools_IndexedMapOfShape all = parts(cad.shape, kind);
    for (int p = 1; p <= all.Extent(); ++p) {
      const std::vector<std::string> own = cad.names.of(all(p));
      if (own.empty()) continue;
      const TopTools_IndexedMapOfShape images = parts(image(all(p)), kind);
      for (int i = 1; i <= images.Extent(); ++i) names.add(images(i), own);
    }
  }
  cad.shape = shape;
  cad.names = names;
}

void heal_shape(CadShape& cad, double tolerance) {
  // A file may have an old triangulation, too coarse or of another shape.
  BRepTools::Clean(cad.shape);
  fix(cad);
  const PartNames names = cad.names;
  const TopTools_ListOfShape doubles = sew_bodies(cad, tolerance);
  sew(cad, tolerance);
  if (doubles.IsEmpty()) return;
  TopoDS_Compound all = empty_compound();
  BRep_Builder().Add(all, cad.shape);
  for (const TopoDS_Shape& face : doubles) {
    BRep_Builder().Add(all, face);
    for (TopExp_Explorer part(face, TopAbs_EDGE); part.More(); part.Next())
      cad.names.add(part.Current(), names.of(part.Current()));
    cad.names.add(face, names.of(face));
  }
  cad.shape = all;
}

bool drop_strips(CadShape& cad, const std::vector<int>& faces) {
  const TopTools_IndexedMapOfShape all = parts(cad.shape, TopAbs_FACE);
  TopTools_IndexedDataMapOfShapeListOfShape faces_of;
  TopExp::MapShapesAndAncestors(cad.shape, TopAbs_EDGE, TopAbs_FACE, faces_of);
  BRepTools_ReShape without;
  std::vector<int> strips;
  double widest = 0;
  for (const int f : faces) {
    if (!has_neighbour(all(f), faces_of)) continue;
    const std::optional<double> width = strip_width(TopoDS::Face(all(f)));
    if (!width) continue;
    without.Remove(all(f));
    strips.push_back(f);
    widest = std::max(widest, *width);
  }
  const TopoDS_Shape rest = without.Apply(cad.shape);
  if (strips.empty() || rest.IsNull() || parts(rest, TopAbs_FACE).IsEmpty()) return false;
  CadShape whole = cad;
  const int before = count_free_edges(cad.shape);
  replace_shape(cad, rest, [&](const TopoDS_Shape& part) { return without.Apply(part); });
  sew(cad, 2 * widest);
  if (count_free_edges(cad.shape) > before) {
    cad = whole;
    return false;
  }
  cad.warnings = whole.warnings;
  cad.warnings.push_back(fmt::format(
      "faces whose edges lie on each other were removed, and their edges sewn: {}", fmt::join(strips, ", ")));
  return true;
}

}  // namespace delquad::cad
