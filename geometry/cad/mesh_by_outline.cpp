// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cad/mesh_by_outline.h"

#include <fmt/format.h>

#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Poly_PolygonOnTriangulation.hxx>
#include <Poly_Triangulation.hxx>
#include <Precision.hxx>
#include <Standard_Failure.hxx>
#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Vertex.hxx>
#include <algorithm>
#include <gp_Pnt.hxx>
#include <map>
#include <optional>

#include "base/text.h"
#include "delquad/error.h"
#include "geometry/mesh/constrained_delaunay.h"
#include "geometry/mesh/triangle_measures.h"

namespace delquad::cad {

namespace {

/// Inside one face. A ball has some 1000; more are seconds of work, here and in maps.
constexpr int kMostPoints = 20'000;
/// Each halves the chords that cross.
constexpr int kMostRounds = 12;
/// Limit of chords of an edge; finer chords would not help.
constexpr int kMostChords = 2000;

/// Returns a face without placement, with forward orientation.
TopoDS_Face plain(const TopoDS_Shape& face) { return TopoDS::Face(unplaced(face).Oriented(TopAbs_FORWARD)); }

/// Throws InputError unless every chord has the face on its left and, except slits, nothing on its right.
void check_sides(const PatchBoundary& boundary, const TriPatch& flat) {
  std::vector<std::array<int, 2>> sides, chords = boundary.edges;
  for (const auto& [a, b, c] : flat.triangles) sides.insert(sides.end(), {{a, b}, {b, c}, {c, a}});
  std::ranges::sort(sides);
  std::ranges::sort(chords);
  for (const auto& [a, b] : boundary.edges) {
    const bool is_slit = std::ranges::binary_search(chords, std::array{b, a});
    if (!std::ranges::binary_search(sides, std::array{a, b}) ||
        (!is_slit && std::ranges::binary_search(sides, std::array{b, a})))
      throw InputError("its boundary runs the wrong way round");
  }
}

/// Throws InputError for a face narrower than the kernel's tolerance for points.
void check_width(const FaceOutline& outline, const RefinedFace& mesh) {
  double area = 0, perimeter = 0;
  for (const auto& v : mesh.flat.triangles) area += norm(area_vector(mesh.points, v)) / 2;
  for (const EdgePassage& passage : outline.passages)
    for (std::size_t k = 0; k + 1 < passage.points.size(); ++k)
      perimeter += norm(outline.points[passage.points[k + 1]] - outline.points[passage.points[k]]);
  if (!(2 * area > Precision::Confusion() * perimeter)) throw InputError("its boundary encloses nothing");
}

/// Stores a triangulation in a face, with the nodes on each edge.
void store(const TopoDS_Face& face, const FaceOutline& outline, const RefinedFace& mesh, Vec2 scale,
           double deflection, EdgeChords& chords) {
  const int n_points = static_cast<int>(mesh.points.size()), n = static_cast<int>(mesh.flat.triangles.size());
  const Handle(Poly_Triangulation) triangulation = new Poly_Triangulation(n_points, n, /*hasUVNodes=*/true);
  for (int i = 0; i < n_points; ++i) {
    const Vec3& p = mesh.points[i];
    triangulation->SetNode(i + 1, {p.x, p.y, p.z});
    triangulation->SetUVNode(i + 1, {mesh.flat.points[i].x / scale.x, mesh.flat.points[i].y / scale.y});
  }
  for (int t = 0; t < n; ++t) {
    const auto& [a, b, c] = mesh.flat.triangles[t];
    triangulation->SetTriangle(t + 1, {a + 1, b + 1, c + 1});
  }
  triangulation->Deflection(deflection);
  BRepTools::Clean(face);
  const BRep_Builder builder;
  builder.UpdateFace(face, triangulation);
  std::map<const EdgePassage*, Handle(Poly_PolygonOnTriangulation)> polygons;
  for (const EdgePassage& passage : outline.passages) {
    const std::vector<double>& parameters = chords.of(passage.edge);
    const int n_nodes = static_cast<int>(passage.points.size());
    TColStd_Array1OfInteger nodes(1, n_nodes);
    TColStd_Array1OfReal at(1, n_nodes);
    for (int k = 0; k < n_nodes; ++k) {
      nodes(k + 1) = passage.points[k] + 1;
      at(k + 1) = parameters[k];
    }
    polygons[&passage] = new Poly_PolygonOnTriangulation(nodes, at);
  }
  for (const EdgePassage& passage : outline.passages) {
    const TopoDS_Edge edge = TopoDS::Edge(passage.edge.Oriented(TopAbs_FORWARD));
    if (!BRep_Tool::IsClosed(passage.edge, face)) {
      builder.UpdateEdge(edge, polygons[&passage], triangulation);
      continue;
    }
    // At a seam the other passage has the other side; other edges have one passage.
    const auto other = std::ranges::find_if(outline.passages, [&](const EdgePassage& p) {
      return &p != &passage && p.edge.IsSame(passage.edge) &&
             p.edge.Orientation() != passage.edge.Orientation();
    });
    const bool is_reversed = passage.edge.Orientation() == TopAbs_REVERSED;
    const auto own = polygons[&passage], second = other == outline.passages.end() ? own : polygons[&*other];
    builder.UpdateEdge(edge, is_reversed ? second : own, is_reversed ? own : second, triangulation);
  }
}

class OutlineMesher {
 public:
  OutlineMesher(const CadShape& cad, double deflection, double angle)
      : bounds_{deflection, angle, kMostPoints}, chords_(cad.shape, deflection, angle) {}

  /// Adds a face. Keeps the current chords of its edges, since it may be their only face with a
  /// triangulation.
  void want(const TopoDS_Shape& face) {
    const TopoDS_Face own = plain(face);
    if (waiting_.Contains(own)) return;
    waiting_.Add(own);
    for (TopExp_Explorer edge(own, TopAbs_EDGE); edge.More(); edge.Next())
      chords_.of(TopoDS::Edge(edge.Current()));
  }

  void mesh_all() {
    separate();
    if (snap_crossing()) separate();
    for (int f = 1; f <= waiting_.Extent(); ++f) mesh(TopoDS::Face(waiting_(f)));
  }

  bool has_meshed(const TopoDS_Shape& face) const { return waiting_.Contains(plain(face)) && !reason(face); }
  bool is_coarse(const TopoDS_Shape& face) const { return coarse_.Contains(plain(face)); }
  std::optional<std::string> reason(const TopoDS_Shape& face) const {
    const int number = waiting_.FindIndex(plain(face));
    const auto at = reasons_.find(number);
    if (at == reasons_.end()) return std::nullopt;
    const auto crossing = crossing_at_.find(number);
    if (crossing == crossing_at_.end()) return at->second;
    const Vec3& x = crossing->second;
    const gp_Pnt p = gp_Pnt(x.x, x.y, x.z).Transformed(face.Location().Transformation());
    return fmt::format("{} near {}", at->second, show_point(vec_of(p)));
  }

 private:
  /// Calls make() for a face; the message of an exception is the reason why it has no mesh.
  template <class Make>
  void attempt(const TopoDS_Face& face, Make make) {
    try {
      make();
    } catch (const InputError& error) {
      reasons_[waiting_.FindIndex(face)] = error.what();
    } catch (const Standard_Failure& failure) {
      reasons_[waiting_.FindIndex(face)] = failure.DynamicType()->Name();
    }
  }

  void separate() {
    for (int round = 0; round < kMostRounds && separate_chords(); ++round) {
    }
  }

  FaceOutline outline(const TopoDS_Face& face) { return outline_of(face, chords_, snapped_.Contains(face)); }

  /// Replaces parts within the tolerance of a vertex by the vertex if halving failed. Returns false if no
  /// chords cross.
  bool snap_crossing() {
    for (int f = 1; f <= waiting_.Extent(); ++f) {
      const TopoDS_Face face = TopoDS::Face(waiting_(f));
      attempt(face, [&] {
        const FaceOutline crossing = outline(face);
        if (crossing_chords(crossing, parameter_scale(*BRep_Tool::Surface(face), crossing.uv)).empty())
          return;
        for (const EdgePassage& passage : crossing.passages) {
          chords_.keep_off_ends(passage.edge);
          for (const TopoDS_Shape& other : chords_.faces_of(passage.edge)) {
            want(other);
            snapped_.Add(other);
          }
        }
      });
    }
    return !snapped_.IsEmpty();
  }

  /// Halves chords that cross in waiting faces; the faces of their edges then wait, too. Returns false if
  /// none cross.
  bool separate_chords() {
    bool any = false;
    for (int f = 1; f <= waiting_.Extent(); ++f) {
      const TopoDS_Face face = TopoDS::Face(waiting_(f));
      attempt(face, [&] {
        const FaceOutline own = outline(face);
        const Vec2 scale = parameter_scale(*BRep_Tool::Surface(face), own.uv);
        std::vector<OutlineChord> crossing = crossing_chords(own, scale);
        // Halves from the last chord back, so that other numbers stay. Both sides of a seam are one edge.
        std::ranges::sort(crossing, [&](const OutlineChord& c, const OutlineChord& d) { return c.k > d.k; });
        for (const OutlineChord& chord : crossing) any = halve(own.passages[chord.passage], chord.k) || any;
      });
    }
    return any;
  }

  bool halve(const EdgePassage& passage, int k) {
    if (std::ssize(chords_.of(passage.edge)) > kMostChords || !chords_.halve(passage.edge, k)) return false;
    for (const TopoDS_Shape& face : chords_.faces_of(passage.edge)) want(face);
    return true;
  }

  void mesh(const TopoDS_Face& face) {
    BRepTools::Clean(face);
    if (reasons_.contains(waiting_.FindIndex(face))) return;
    attempt(face, [&] {
      const Handle(Geom_Surface) surface = BRep_Tool::Surface(face);
      const FaceOutline outline = this->outline(face);
      const Vec2 scale = parameter_scale(*surface, outline.uv);
      if (const auto crossing = crossing_chords(outline, scale); !crossing.empty()) {
        const auto& [passage, k] = crossing[0];
        crossing_at_[waiting_.FindIndex(face)] = outline.points[outline.passages[passage].points[k]];
        throw InputError("its boundary crosses or touches itself");
      }
      const PatchBoundary boundary = boundary_of(outline, scale);
      const TriPatch start = constrained_delaunay(boundary);
      check_sides(boundary, start);
      FaceBounds bounds = bounds_;
      // Vertices may be so far off the surface that points beside them would fold it.
      if (snapped_.Contains(face))
        for (TopExp_Explorer vertex(face, TopAbs_VERTEX); vertex.More(); vertex.Next())
          bounds.deflection =
              std::max(bounds.deflection, BRep_Tool::Tolerance(TopoDS::Vertex(vertex.Current())));
      const RefinedFace refined = refine_face(*surface, start, outline.points, scale, bounds);
      check_width(outline, refined);
      store(face, outline, refined, scale, bounds_.deflection, chords_);
      if (!refined.is_complete) coarse_.Add(face);
    });
  }

  FaceBounds bounds_;
  EdgeChords chords_;
  TopTools_IndexedMapOfShape waiting_, coarse_;
  TopTools_IndexedMapOfShape snapped_;  ///< faces whose outlines end at tolerances of vertices
  std::map<int, std::string> reasons_;  ///< reasons of waiting faces that cannot be meshed
  std::map<int, Vec3> crossing_at_;     ///< place where the boundary of an unplaced face crosses itself
};

}  // namespace

OutlineMeshes mesh_by_outline(const CadShape& cad, const TopTools_IndexedMapOfShape& faces,
                              const std::vector<int>& wanted, double deflection, double angle) {
  // Old triangulations are unusable, and must not determine chords.
  for (const int f : wanted) BRepTools::Clean(faces(f));
  OutlineMesher mesher(cad, deflection, angle);
  for (const int f : wanted) mesher.want(faces(f));
  mesher.mesh_all();
  OutlineMeshes result;
  for (int f = 1; f <= faces.Extent(); ++f) {
    if (mesher.has_meshed(faces(f))) result.meshed.push_back(f);
    if (mesher.is_coarse(faces(f))) result.coarse.push_back(f);
    if (const auto reason = mesher.reason(faces(f))) result.failed.emplace_back(f, *reason);
  }
  return result;
}

}  // namespace delquad::cad
