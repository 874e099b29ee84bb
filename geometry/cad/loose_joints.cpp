// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cad/loose_joints.h"

#include <BRepAdaptor_Curve.hxx>
#include <BRepBuilderAPI_MakeVertex.hxx>
#include <BRepExtrema_DistShapeShape.hxx>
#include <BRep_Tool.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Vertex.hxx>
#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <utility>

#include "base/box.h"
#include "base/box_tree.h"
#include "base/disjoint_sets.h"
#include "base/parallel.h"
#include "geometry/cad/cad_shape.h"
#include "geometry/mesh/half_edges.h"

namespace delquad::cad {

namespace {

using Pair = std::array<int, 2>;

Pair in_order(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

class JointFinder {
 public:
  JointFinder(const SurfaceModel& model, const TopTools_IndexedMapOfShape& faces,
              const std::vector<std::vector<int>>& shells, const JointOptions& options)
      : mesh_(model.fine), shapes_(faces), options_(options), faces_(mesh_.regions.size()) {
    for (int s = 0; s < std::ssize(shells); ++s)
      for (const int f : shells[s]) faces_[f].shells.push_back(s);
    for (int t = 0; t < std::ssize(mesh_.triangles); ++t) {
      Face& face = faces_[mesh_.triangle_region[t]];
      if (face.boxes.empty()) face.box = box_of(t);
      face.boxes.push_back(box_of(t));
      for (const int v : mesh_.triangles[t]) face.box.add(mesh_.points[v]);
      if (face.largest < 0 || area_of(t) > area_of(face.largest)) face.largest = t;
    }
    for (int f = 0; f < std::ssize(faces_); ++f) {
      find_edges(f);
      TopExp::MapShapesAndAncestors(shapes_(f + 1), TopAbs_EDGE, TopAbs_FACE, faces_with_);
    }
    for (int e = 1; e <= faces_with_.Extent(); ++e)
      if (is_free(faces_with_.FindKey(e)))
        TopExp::MapShapes(faces_with_.FindKey(e), TopAbs_VERTEX, free_vertices_);
    find_parts();
  }

  LooseJoints find() {
    std::vector<Pair> pairs = near_pairs();
    // Faces that may touch come first, as one such place is enough.
    std::ranges::stable_partition(
        pairs, [&](const Pair& pair) { return come_near(pair[0], pair[1], options_.tolerance); });
    std::map<std::array<int, 4>, std::vector<Pair>> pairs_of;  // by parts; in one part by faces
    for (const auto& [f, g] : pairs) {
      const auto [p, q] = in_order(faces_[f].part, faces_[g].part);
      pairs_of[p == q ? std::array{p, q, f, g} : std::array{p, q, 0, 0}].push_back({f, g});
    }
    std::vector<std::vector<Pair>> groups;
    for (auto& [key, group] : pairs_of) groups.push_back(std::move(group));
    std::vector<std::optional<LooseJoint>> nearest(groups.size());
    parallel_for(groups.size(), [&](std::size_t i) {
      for (const auto& [f, g] : groups[i]) {
        if (nearest[i] && nearest[i]->distance <= options_.tolerance) return;
        const std::optional<LooseJoint> joint = joint_of(f, g);
        if (joint && (!nearest[i] || joint->distance < nearest[i]->distance - options_.tolerance))
          nearest[i] = joint;
      }
    });
    LooseJoints all;
    for (const std::optional<LooseJoint>& joint : nearest) {
      if (!joint) continue;
      if (joint->distance <= options_.tolerance)
        all.touching.push_back({joint->faces, joint->at, 0});
      else
        all.near.push_back(*joint);
    }
    std::ranges::sort(all.touching, {}, &LooseJoint::faces);
    return all;
  }

 private:
  struct Face {
    std::vector<int> shells;       ///< ascending
    std::vector<Box<Vec3>> boxes;  ///< of triangles
    Box<Vec3> box{};
    int part = -1, largest = -1;  ///< largest triangle
    TopTools_IndexedMapOfShape vertices, edges;
    std::optional<BoxTree<Vec3>> tree{};
  };

  const Vec3& corner(int t, int k) const { return mesh_.points[mesh_.triangles[t][k]]; }
  Box<Vec3> box_of(int t) const { return Box<Vec3>::around({corner(t, 0), corner(t, 1), corner(t, 2)}); }
  double area_of(int t) const {
    return norm(cross(corner(t, 1) - corner(t, 0), corner(t, 2) - corner(t, 0)));
  }

  /// Collects the edges of a face that are curves of the mesh, and their ends; seams are none.
  void find_edges(int f) {
    for (TopExp_Explorer at(shapes_(f + 1), TopAbs_EDGE); at.More(); at.Next()) {
      const TopoDS_Edge& edge = TopoDS::Edge(at.Current());
      if (BRep_Tool::Degenerated(edge) || BRep_Tool::IsClosed(edge, TopoDS::Face(shapes_(f + 1)))) continue;
      faces_[f].edges.Add(edge);
      TopExp::MapShapes(edge, TopAbs_VERTEX, faces_[f].vertices);
    }
  }

  void find_parts() {
    const std::vector<HalfEdge> sides = sorted_half_edges(mesh_);
    const auto face_of = [&](const HalfEdge& side) { return mesh_.triangle_region[side.element]; };
    DisjointSets joined(faces_.size());
    for_each_edge(sides, [&](std::span<const HalfEdge> edge) {
      for (const HalfEdge& side : edge) joined.join(face_of(edge[0]), face_of(side));
    });
    for (int f = 0; f < std::ssize(faces_); ++f) faces_[f].part = joined.root(f);
    is_open_.assign(faces_.size(), 0);
    for_each_edge(sides, [&](std::span<const HalfEdge> edge) {
      if (edge.size() == 1) is_open_[faces_[face_of(edge[0])].part] = 1;
    });
  }

  bool are_of_one_shell(int f, int g) const {
    const Face &first = faces_[f], &second = faces_[g];
    return (first.part == second.part && is_open_[first.part] == 0 &&
            (first.shells.empty() || second.shells.empty())) ||
           std::ranges::any_of(first.shells,
                               [&](int s) { return std::ranges::binary_search(second.shells, s); });
  }

  static bool share(const TopTools_IndexedMapOfShape& some, const TopTools_IndexedMapOfShape& others) {
    return std::any_of(some.cbegin(), some.cend(), [&](const TopoDS_Shape& s) { return others.Contains(s); });
  }
  /// Returns whether all edges of one face are edges of the other.
  bool have_one_rim(int f, int g) const {
    const TopTools_IndexedMapOfShape &first = faces_[f].edges, &second = faces_[g].edges;
    const auto includes = [](const TopTools_IndexedMapOfShape& all, const TopTools_IndexedMapOfShape& some) {
      return std::all_of(some.cbegin(), some.cend(), [&](const TopoDS_Shape& s) { return all.Contains(s); });
    };
    return !first.IsEmpty() && !second.IsEmpty() && (includes(first, second) || includes(second, first));
  }

  /// Returns the pairs of faces, in order, with near triangles and no common shell, or with one rim.
  std::vector<Pair> near_pairs() {
    std::vector<Box<Vec3>> boxes;
    for (const Face& face : faces_) boxes.push_back(face.box.grown(options_.reach / 2 + options_.deflection));
    const BoxTree<Vec3> tree(boxes);
    std::vector<Pair> pairs;
    for (int f = 0; f < std::ssize(faces_); ++f)
      tree.overlapping(boxes[f], [&](int g) {
        if (g <= f || faces_[f].boxes.empty() || faces_[g].boxes.empty() || !boxes[f].overlaps(boxes[g]))
          return;
        if (are_of_one_shell(f, g) ? have_one_rim(f, g) : come_near(f, g, options_.reach))
          pairs.push_back({f, g});
      });
    std::ranges::sort(pairs);
    return pairs;
  }

  /// Returns whether the faces may come as near as `reach`.
  bool come_near(int f, int g, double reach) {
    if (!faces_[g].tree) faces_[g].tree.emplace(faces_[g].boxes);
    return std::ranges::any_of(faces_[f].boxes, [&](const Box<Vec3>& own) {
      const Box<Vec3> box = own.grown(reach + 2 * options_.deflection);
      bool is_near = false;
      if (box.overlaps(faces_[g].box))
        faces_[g].tree->overlapping(box,
                                    [&](int t) { is_near = is_near || box.overlaps(faces_[g].boxes[t]); });
      return is_near;
    });
  }

  /// Returns the distance of a place from a face.
  double distance(const Vec3& x, int face) const {
    BRepExtrema_DistShapeShape nearest(BRepBuilderAPI_MakeVertex(gp_Pnt(x.x, x.y, x.z)).Vertex(),
                                       shapes_(face + 1));
    return nearest.IsDone() ? nearest.Value() : std::numeric_limits<double>::infinity();
  }

  std::optional<LooseJoint> joint_of(int f, int g) const {
    if (share(faces_[f].vertices, faces_[g].vertices)) return joint_of_neighbors(f, g);
    const BRepExtrema_DistShapeShape nearest(shapes_(f + 1), shapes_(g + 1));
    if (!nearest.IsDone() || nearest.NbSolution() == 0 || nearest.Value() > options_.reach)
      return std::nullopt;
    // In one part, as in a bent sheet, near faces count only at free edges, which could be joined.
    if (nearest.Value() > options_.tolerance && faces_[f].part == faces_[g].part && !is_free(nearest, 1) &&
        !is_free(nearest, 2))
      return std::nullopt;
    return LooseJoint{{f, g}, vec_of(nearest.PointOnShape1(1)), nearest.Value()};
  }

  /// Returns the joint of faces that share a vertex: they lie on each other at their middles, or touch at the
  /// middle of an edge.
  std::optional<LooseJoint> joint_of_neighbors(int f, int g) const {
    for (const auto& [a, b] : {Pair{f, g}, Pair{g, f}}) {
      std::vector<Vec3> places;
      for (int e = 1; e <= faces_[a].edges.Extent(); ++e) {
        const TopoDS_Edge& edge = TopoDS::Edge(faces_[a].edges(e));
        if (faces_[b].edges.Contains(edge) || !is_free(edge)) continue;
        const BRepAdaptor_Curve curve(edge);
        places.push_back(vec_of(curve.Value((curve.FirstParameter() + curve.LastParameter()) / 2)));
      }
      if (const int t = faces_[a].largest; have_one_rim(a, b))
        places.push_back(1.0 / 3 * (corner(t, 0) + corner(t, 1) + corner(t, 2)));
      for (const Vec3& x : places)
        if (const double apart = distance(x, b); apart <= options_.tolerance)
          return LooseJoint{{a, b}, x, apart};
    }
    return std::nullopt;
  }

  bool is_free(const TopoDS_Shape& edge) const {
    return !BRep_Tool::Degenerated(TopoDS::Edge(edge)) && faces_with_.FindFromKey(edge).Extent() == 1;
  }
  static TopoDS_Shape support(const BRepExtrema_DistShapeShape& nearest, int side) {
    return side == 1 ? nearest.SupportOnShape1(1) : nearest.SupportOnShape2(1);
  }
  bool is_free(const BRepExtrema_DistShapeShape& nearest, int side) const {
    const TopoDS_Shape at = support(nearest, side);
    return free_vertices_.Contains(at) || (at.ShapeType() == TopAbs_EDGE && is_free(at));
  }

  const Mesh& mesh_;
  const TopTools_IndexedMapOfShape& shapes_;
  JointOptions options_;
  std::vector<Face> faces_;
  std::vector<char> is_open_;                             ///< by part
  TopTools_IndexedDataMapOfShapeListOfShape faces_with_;  ///< by edge
  TopTools_IndexedMapOfShape free_vertices_;
};

/// Returns whether a vertex of a face lies inside of the face.
bool is_inside(const TopoDS_Face& face, const TopoDS_Shape& vertex,
               const TopTools_IndexedDataMapOfShapeListOfShape& faces_of) {
  for (TopExp_Explorer at(face, TopAbs_EDGE); at.More(); at.Next()) {
    const TopoDS_Edge& edge = TopoDS::Edge(at.Current());
    if (!parts(edge, TopAbs_VERTEX).Contains(vertex) || BRep_Tool::Degenerated(edge)) continue;
    const TopTools_ListOfShape& with_edge = faces_of.FindFromKey(edge);
    if (!BRep_Tool::IsClosed(edge, face) ||
        !std::all_of(with_edge.begin(), with_edge.end(), [&](const auto& f) { return f.IsSame(face); }))
      return false;
  }
  return true;
}

}  // namespace

std::vector<LooseJoint> joints_at_points(const TopTools_IndexedMapOfShape& faces) {
  TopTools_IndexedDataMapOfShapeListOfShape faces_of;
  for (int f = 1; f <= faces.Extent(); ++f)
    for (const TopAbs_ShapeEnum kind : {TopAbs_EDGE, TopAbs_VERTEX})
      TopExp::MapShapesAndAncestors(faces(f), kind, TopAbs_FACE, faces_of);
  // Connected faces may meet in a point, as a pocket may touch the floor; meshes allow it.
  DisjointSets hanging(faces.Extent());
  for (int e = 1; e <= faces_of.Extent(); ++e)
    if (faces_of.FindKey(e).ShapeType() == TopAbs_EDGE)
      for (const TopoDS_Shape& face : faces_of(e))
        hanging.join(faces.FindIndex(faces_of(e).First()) - 1, faces.FindIndex(face) - 1);
  const auto part_of = [&](const TopoDS_Shape& face) { return hanging.root(faces.FindIndex(face) - 1); };
  std::vector<LooseJoint> joints;
  for (int v = 1; v <= faces_of.Extent(); ++v) {
    const TopoDS_Shape& vertex = faces_of.FindKey(v);
    if (vertex.ShapeType() != TopAbs_VERTEX) continue;
    const TopTools_ListOfShape& all = faces_of(v);
    const auto other = std::find_if(
        all.begin(), all.end(), [&](const TopoDS_Shape& f) { return part_of(f) != part_of(all.First()); });
    if (other == all.end()) continue;
    for (const TopoDS_Shape& face : all) {
      if (!is_inside(TopoDS::Face(face), vertex, faces_of)) continue;
      const TopoDS_Shape& touched = part_of(face) == part_of(all.First()) ? *other : all.First();
      joints.push_back({{faces.FindIndex(face) - 1, faces.FindIndex(touched) - 1},
                        vec_of(BRep_Tool::Pnt(TopoDS::Vertex(vertex))),
                        0});
      break;
    }
  }
  return joints;
}

LooseJoints loose_joints(const SurfaceModel& model, const TopTools_IndexedMapOfShape& faces,
                         const std::vector<std::vector<int>>& shells, const JointOptions& options) {
  return model.fine.regions.size() < 2 ? LooseJoints{} : JointFinder(model, faces, shells, options).find();
}

}  // namespace delquad::cad
