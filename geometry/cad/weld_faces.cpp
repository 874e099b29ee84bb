// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cad/weld_faces.h"

#include <fmt/format.h>

#include <BRep_Tool.hxx>
#include <Poly_PolygonOnTriangulation.hxx>
#include <Poly_Triangulation.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Vertex.hxx>
#include <algorithm>
#include <set>
#include <utility>

#include "base/disjoint_sets.h"
#include "delquad/error.h"
#include "geometry/mesh/half_edges.h"

namespace delquad::cad {

namespace {

Handle(Poly_PolygonOnTriangulation) polygon_of(const TopoDS_Edge& edge, const TopoDS_Face& face) {
  TopLoc_Location place;
  const Handle(Poly_Triangulation)& triangulation = BRep_Tool::Triangulation(face, place);
  return BRep_Tool::PolygonOnTriangulation(edge, triangulation, place);
}

class Welder {
 public:
  Welder(const std::vector<FaceMesh>& faces, const TopTools_IndexedMapOfShape& edges, double gap)
      : faces_(faces), edges_(edges), gap_(gap), uses_(edges.Extent()), boundary_(faces.size()) {}

  WeldedFaces weld() {
    for (std::size_t f = 0; f < faces_.size(); ++f) add_face(static_cast<int>(f));
    WeldedFaces welded;
    add_triangles(welded.mesh);
    number_points(welded.mesh);
    welded.inside = split_duplicate_sides(welded.mesh, numbered_boundaries());
    for (const HalfEdge& side : sorted_half_edges(welded.mesh)) sides_.push_back({side.lo, side.hi});
    for (int e = 0; e < edges_.Extent(); ++e) add_curve(e, welded);
    find_corners(welded);
    welded.bad_faces = std::move(bad_faces_);
    return welded;
  }

 private:
  /// An edge as its faces have it.
  struct EdgeUse {
    std::vector<int> nodes;          ///< nodes by ascending parameter
    std::vector<double> parameters;  ///< parameters of the nodes
    int first_face = -1;
    int n_passages = 0;    ///< passages of first_face's boundary along it
    bool is_seam = false;  ///< whether first_face lies on both sides of it
    bool is_shared = false;
    std::vector<int> inside_of;  ///< faces with the edge inside, ascending
  };

  int new_node(const Vec3& p) {
    points_.push_back(p);
    return sets_.add();
  }

  int vertex_node(const TopoDS_Vertex& vertex, const Vec3& otherwise) {
    if (vertex.IsNull()) return new_node(otherwise);
    const int known = vertices_.Extent();
    const int v = vertices_.Add(vertex);
    if (v > known) vertex_nodes_.push_back(new_node(vec_of(BRep_Tool::Pnt(vertex))));
    return vertex_nodes_[v - 1];
  }

  /// Joins the nodes of an edge in one face to the nodes of the edge.
  void add_edge(int f, const TopoDS_Edge& edge, std::vector<int>& node_of) {
    const Handle(Poly_PolygonOnTriangulation) polygon = polygon_of(edge, faces_[f].face);
    if (polygon.IsNull() || polygon->NbNodes() < 2) return;
    EdgeUse& use = uses_[edges_.FindIndex(edge) - 1];
    const int n = polygon->NbNodes();
    const auto local = [&](int k) { return polygon->Nodes()(k + 1) - 1; };
    if (use.first_face < 0) {
      use.first_face = f;
      const TopoDS_Edge forward = TopoDS::Edge(edge.Oriented(TopAbs_FORWARD));
      const bool degenerate = BRep_Tool::Degenerated(edge);
      for (int k = 0; k < n; ++k) {
        const Vec3& p = faces_[f].points[local(k)];
        if (k == 0 || degenerate) {
          use.nodes.push_back(vertex_node(TopExp::FirstVertex(forward), p));
        } else if (k == n - 1) {
          use.nodes.push_back(vertex_node(TopExp::LastVertex(forward), p));
        } else {
          use.nodes.push_back(new_node(p));
        }
        use.parameters.push_back(polygon->HasParameters() ? polygon->Parameters()->Value(k + 1) : k);
      }
    }
    if (use.first_face != f)
      use.is_shared = true;
    else
      use.is_seam = ++use.n_passages == 2 && BRep_Tool::IsClosed(edge, faces_[f].face);
    if (static_cast<int>(use.nodes.size()) != n) {
      throw InputError(
          fmt::format("face {}: its triangulation does not fit the triangulation of its neighbor, face {}",
                      f + 1, use.first_face + 1));
    }
    for (int k = 0; k < n; ++k) {
      int& node = node_of[local(k)];
      if (node < 0) node = use.nodes[k];
      sets_.join(node, use.nodes[k]);
    }
    // The face lies on the left of a forward edge.
    const bool reversed = edge.Orientation() == TopAbs_REVERSED;
    if (!reversed && edge.Orientation() != TopAbs_FORWARD) {
      if (use.inside_of.empty() || use.inside_of.back() != f) use.inside_of.push_back(f);
      return;
    }
    for (int k = 0; k + 1 < n; ++k) {
      std::array<int, 2> side{use.nodes[k], use.nodes[k + 1]};
      if (reversed != faces_[f].is_reversed) std::swap(side[0], side[1]);
      boundary_[f].push_back(side);
    }
  }

  void add_face(int f) {
    const FaceMesh& mesh = faces_[f];
    std::vector<int>& node_of = node_of_.emplace_back(mesh.points.size(), -1);
    if (mesh.triangles.empty()) return;
    for (TopExp_Explorer edge(mesh.face.Oriented(TopAbs_FORWARD), TopAbs_EDGE); edge.More(); edge.Next()) {
      if (edge.Current().Orientation() != TopAbs_EXTERNAL) add_edge(f, TopoDS::Edge(edge.Current()), node_of);
    }
    for (std::size_t i = 0; i < node_of.size(); ++i)
      if (node_of[i] < 0) node_of[i] = new_node(mesh.points[i]);
  }

  /// Returns the triangles of a face between nodes, without degenerate ones, repaired up to its boundary.
  std::vector<std::array<int, 3>> whole_face(int f) {
    std::vector<std::array<int, 3>> triangles;
    for (const auto& [a, b, c] : faces_[f].triangles) {
      const std::array<int, 3> v{find(f, a), find(f, b), find(f, c)};
      if (v[0] != v[1] && v[1] != v[2] && v[2] != v[0]) triangles.push_back(v);
    }
    std::vector<std::array<int, 2>> boundary;
    for (const auto& [a, b] : boundary_[f]) {
      const std::array<int, 2> side{sets_.root(a), sets_.root(b)};
      if (side[0] != side[1]) boundary.push_back(side);
    }
    if (repair_face(points_, boundary, triangles) > gap_ || !is_manifold(triangles)) bad_faces_.push_back(f);
    return triangles;
  }
  int find(int f, int local) { return sets_.root(node_of_[f][local]); }

  void add_triangles(Mesh& mesh) {
    for (int f = 0; f < static_cast<int>(faces_.size()); ++f) {
      mesh.regions.push_back({f + 1, {}});
      for (const auto& triangle : whole_face(f)) {
        mesh.triangles.push_back(triangle);
        mesh.triangle_region.push_back(f);
      }
    }
  }

  /// Numbers the points of nodes that triangles use, in the order of nodes.
  void number_points(Mesh& mesh) {
    number_.assign(points_.size(), -1);
    for (const auto& triangle : mesh.triangles)
      for (const int node : triangle) number_[node] = 0;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      if (number_[i] < 0) continue;
      number_[i] = static_cast<int>(mesh.points.size());
      mesh.points.push_back(points_[i]);
    }
    for (auto& triangle : mesh.triangles)
      for (int& node : triangle) node = number_[node];
  }

  /// Returns the boundaries by points, with the edges inside of faces.
  std::vector<std::vector<std::array<int, 2>>> numbered_boundaries() {
    std::vector<std::vector<std::array<int, 2>>> sides(boundary_.size());
    for (const EdgeUse& use : uses_)
      for (const int f : use.inside_of)
        for (std::size_t k = 0; k + 1 < use.nodes.size(); ++k)
          boundary_[f].push_back({use.nodes[k], use.nodes[k + 1]});
    for (std::size_t f = 0; f < boundary_.size(); ++f) {
      for (const auto& [a, b] : boundary_[f]) {
        const int p = number_[sets_.root(a)], q = number_[sets_.root(b)];
        sides[f].push_back({std::min(p, q), std::max(p, q)});
      }
      std::ranges::sort(sides[f]);
    }
    return sides;
  }

  void add_curve(int e, WeldedFaces& welded) {
    const EdgeUse& use = uses_[e];
    if (use.nodes.empty() || (use.is_seam && !use.is_shared)) return;
    CurveMesh curve{TopoDS::Edge(edges_(e + 1)), {}};
    std::vector<int> chain;
    for (std::size_t k = 0; k < use.nodes.size(); ++k) {
      const int point = number_[sets_.root(use.nodes[k])];
      if (point < 0 || (!chain.empty() && chain.back() == point)) continue;
      chain.push_back(point);
      curve.parameters.push_back(use.parameters[k]);
    }
    if (chain.size() < 2) return;
    Mesh& mesh = welded.mesh;
    // Coinciding edges of one face bound nothing. If edges of several faces coincide, as at the common side
    // of two holes, the first has the lines.
    const auto bounds_something = [&](std::size_t k) {
      const auto [a, b] = std::minmax(chain[k], chain[k + 1]);
      return std::ranges::binary_search(sides_, std::array{a, b}) && on_curves_.insert({a, b}).second;
    };
    bool is_curve = false;
    for (std::size_t k = 0; k + 1 < chain.size(); ++k) {
      if (!bounds_something(k)) continue;
      is_curve = true;
      mesh.lines.push_back({chain[k], chain[k + 1]});
      mesh.line_curve.push_back(static_cast<int>(mesh.curves.size()));
    }
    if (!is_curve) return;
    for (const int f : use.inside_of) welded.embedded.push_back({static_cast<int>(mesh.curves.size()), f});
    mesh.curves.push_back({e + 1, {}});
    welded.curves.push_back(std::move(curve));
  }

  static void find_corners(WeldedFaces& welded) {
    const Mesh& mesh = welded.mesh;
    std::vector<int> n_lines(mesh.points.size(), 0), curve(mesh.points.size(), -1);
    std::vector<char> is_corner(mesh.points.size(), 0);
    for (std::size_t l = 0; l < mesh.lines.size(); ++l) {
      for (const int v : mesh.lines[l]) {
        if (++n_lines[v] > 2 || (curve[v] >= 0 && curve[v] != mesh.line_curve[l])) is_corner[v] = 1;
        curve[v] = mesh.line_curve[l];
      }
    }
    for (std::size_t v = 0; v < mesh.points.size(); ++v)
      if (is_corner[v] || n_lines[v] == 1) welded.corners.push_back(static_cast<int>(v));
  }

  const std::vector<FaceMesh>& faces_;
  const TopTools_IndexedMapOfShape& edges_;
  double gap_;
  std::vector<EdgeUse> uses_;                              ///< use of each edge
  std::vector<std::vector<std::array<int, 2>>> boundary_;  ///< sides (nodes) on the boundary of each face
  TopTools_IndexedMapOfShape vertices_;
  std::vector<int> vertex_nodes_;
  std::vector<Vec3> points_;  ///< place of each node
  DisjointSets sets_;
  std::vector<std::vector<int>> node_of_;  ///< node of each point of each face
  std::vector<int> bad_faces_;
  std::vector<std::array<int, 2>> sides_;   ///< sides of triangles between points, sorted
  std::vector<int> number_;                 ///< point of the mesh of each node; -1: none
  std::set<std::array<int, 2>> on_curves_;  ///< sides that are lines of curves
};

}  // namespace

WeldedFaces weld_faces(const std::vector<FaceMesh>& faces, const TopTools_IndexedMapOfShape& edges,
                       double gap) {
  return Welder(faces, edges, gap).weld();
}

WeldedFaces weld_usable(std::vector<FaceMesh>& meshes, const TopTools_IndexedMapOfShape& edges, double gap,
                        std::vector<std::string>& why_not) {
  for (;;) {
    WeldedFaces welded = weld_faces(meshes, edges, gap);
    if (welded.bad_faces.empty()) return welded;
    for (const int f : welded.bad_faces) {
      why_not[f] = "cannot be triangulated up to the boundary (does it cross itself?)";
      meshes[f].triangles.clear();
    }
  }
}

}  // namespace delquad::cad
