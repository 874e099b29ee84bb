// SPDX-License-Identifier: GPL-3.0-or-later
#include "algorithms/fields/background_mesh.h"

#include <CGAL/Delaunay_mesh_criteria_2.h>
#include <CGAL/Delaunay_mesh_face_base_2.h>
#include <CGAL/Delaunay_mesh_vertex_base_2.h>
#include <CGAL/Delaunay_mesher_2.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <tuple>
#include <utility>

#include "base/box_tree.h"
#include "base/cancel.h"
#include "base/predicates.h"
#include "base/segment.h"
#include "delquad/error.h"
#include "geometry/mesh/patch_cdt.h"

namespace delquad {

namespace {

// Least squared sine of an angle: 20.7 degrees, for which refinement is known to end (corners of less
// excepted).
constexpr double kShape = 0.125;
// Refinement stops at this many vertices for each vertex of the boundary, plus a few. It normally needs less
// than half. A mesh that stops there is still a triangulation, only with worse angles.
constexpr std::size_t kMostGrowth = 8, kMostExtra = 1000;

using Kernel = patch_cdt::Kernel;
using VertexBase = CGAL::Delaunay_mesh_vertex_base_2<Kernel, patch_cdt::VertexBase>;
using FaceConstraint = CGAL::Constrained_Delaunay_triangulation_face_base_2<
    Kernel, CGAL::Constrained_triangulation_face_base_2<Kernel, patch_cdt::FaceBase>>;
using FaceBase = CGAL::Delaunay_mesh_face_base_2<Kernel, FaceConstraint>;
using Structure = CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>;
using Cdt =
    CGAL::Constrained_Delaunay_triangulation_2<Kernel, Structure, CGAL::No_constraint_intersection_tag>;
using Criteria = CGAL::Delaunay_mesh_criteria_2<Cdt>;

// Both sides of a slit are some 1e-6 of its edges apart, and refinement leaves some of these shorter.
constexpr double kSlit = 3e-5;
// Steps that add nothing, and so many more for each vertex: far more than faces are dropped and edges listed.
constexpr std::size_t kMostInVain = 10000, kInVainPerVertex = 4;

/// CGAL's test of an edge by the circle around it and the vertices on both sides, but without vertices across
/// a slit. If slits turn or cross, vertices on one side are in the circles of the other side's edges. Both
/// sides would be split in turn, down to the slit's width.
struct GabrielBesideSlits : CGAL::Mesh_2::Is_locally_conforming_Gabriel<Cdt> {
  using Gabriel = CGAL::Mesh_2::Is_locally_conforming_Gabriel<Cdt>;
  using Gabriel::operator();

  bool operator()(const Cdt& cdt, const Cdt::Face_handle& f, int i) const {
    return conforms(cdt, f, i) && conforms(cdt, f->neighbor(i), cdt.mirror_index(f, i));
  }
  bool operator()(const Cdt& cdt, const Cdt::Vertex_handle& a, const Cdt::Vertex_handle& b) const {
    Cdt::Face_handle f;
    int i = 0;
    cdt.is_edge(a, b, f, i);
    return (*this)(cdt, f, i);
  }

 private:
  bool conforms(const Cdt& cdt, const Cdt::Face_handle& f, int i) const {
    const Cdt::Vertex_handle apex = f->vertex(i), a = f->vertex(Cdt::cw(i)), b = f->vertex(Cdt::ccw(i));
    if (cdt.is_infinite(apex) || Gabriel::operator()(cdt, a, b, apex->point())) return true;
    const auto side = b->point() - a->point(), to = apex->point() - a->point();
    const double height = std::abs(side.x() * to.y() - side.y() * to.x());  // height times side
    return !f->is_in_domain() && height <= kSlit * side.squared_length();
  }
};

/// CGAL::Delaunay_mesher_2 of a marked domain, with another test of edges.
template <class Test>
class Refiner {
 public:
  explicit Refiner(Cdt& cdt)
      : clusters_(cdt),
        edges_(cdt, clusters_, nothing_),
        faces_(cdt, criteria_, edges_),
        visitor_(faces_, edges_, no_visitor_) {
    clusters_.create_clusters();
    edges_.scan_triangulation();
    faces_.scan_triangulation();
  }
  /// False where nothing is left to do.
  bool step() { return faces_.one_step(visitor_); }

 private:
  using Edges = CGAL::Mesh_2::Refine_edges_with_clusters<Cdt, Test>;
  using Faces = CGAL::Mesh_2::Refine_faces<Cdt, Criteria, Edges>;

  Criteria criteria_{kShape};
  CGAL::Null_mesher_level nothing_;
  CGAL::Null_mesh_visitor no_visitor_;
  CGAL::Mesh_2::Clusters<Cdt> clusters_;
  Edges edges_;
  Faces faces_;
  CGAL::Mesh_2::Refine_edges_visitor_from_faces<Faces> visitor_;
};

/// Numbers the faces of the patch so that most are near the one before.
std::vector<Cdt::Face_handle> number_faces(Cdt& cdt) {
  std::vector<Cdt::Face_handle> order, stack;
  for (auto f = cdt.all_faces_begin(); f != cdt.all_faces_end(); ++f) f->info() = -1;
  for (auto first = cdt.finite_faces_begin(); first != cdt.finite_faces_end(); ++first) {
    stack.push_back(first);
    while (!stack.empty()) {
      const Cdt::Face_handle f = stack.back();
      stack.pop_back();
      if (!f->is_in_domain() || f->info() >= 0) continue;
      f->info() = static_cast<int>(order.size());
      order.push_back(f);
      for (int k = 0; k < 3; ++k) stack.push_back(f->neighbor(k));
    }
  }
  return order;
}

TriPatch extract(Cdt& cdt, const PatchBoundary& patch) {
  TriPatch tri;
  tri.points = patch.points;
  tri.n_boundary = static_cast<int>(patch.points.size());
  for (const Cdt::Face_handle f : number_faces(cdt)) {
    auto& vertices = tri.triangles.emplace_back();
    auto& neighbours = tri.neighbours.emplace_back();
    for (int k = 0; k < 3; ++k) {
      const auto v = f->vertex(k);
      if (v->info().value < 0) {
        v->info().value = static_cast<int>(tri.points.size());
        tri.points.push_back({v->point().x(), v->point().y()});
      }
      vertices[k] = v->info().value;
      neighbours[k] = f->neighbor(k)->info();
    }
  }
  return tri;
}

/// Returns whether the patch is on both sides of an edge, or its boundary passes a node twice.
bool has_slits(const PatchBoundary& patch) {
  std::vector<int> nodes = patch.point_node;
  std::ranges::sort(nodes);
  return std::ranges::adjacent_find(nodes) != nodes.end();
}

/// If many steps add nothing, refinement stops, and there is no result if it `must_end`. Slivers
/// inside may keep the weaker test from its end, and points nearer to edges than rounding both tests.
template <class Test>
std::optional<TriPatch> refined(const PatchBoundary& patch, bool must_end) {
  Cdt cdt;
  const auto vertex = patch_cdt::insert(cdt, patch, patch.points);
  for (auto f = cdt.all_faces_begin(); f != cdt.all_faces_end(); ++f) f->set_in_domain(false);
  for (const auto f : patch_cdt::number_inside(cdt, patch, vertex)) f->set_in_domain(true);
  Refiner<Test> refiner(cdt);
  const std::size_t most = kMostGrowth * patch.points.size() + kMostExtra;
  std::size_t in_vain = 0;
  for (std::size_t n = cdt.number_of_vertices(); n < most && refiner.step();) {
    check_cancelled();
    const std::size_t before = std::exchange(n, cdt.number_of_vertices());
    in_vain += n == before ? 1 : 0;
    if (in_vain < kMostInVain + kInVainPerVertex * most) continue;
    if (must_end) return std::nullopt;
    break;
  }
  return extract(cdt, patch);
}

/// Returns a triangulation of the patch with few small angles, as coarse as its boundary edges allow, which
/// may be split. Points of the boundary come first, in their order. Throws InputError if the boundary crosses
/// itself.
TriPatch refine_patch(const PatchBoundary& patch) {
  if (has_slits(patch))
    if (auto tri = refined<GabrielBesideSlits>(patch, true)) return *std::move(tri);
  return *refined<CGAL::Mesh_2::Is_locally_conforming_Gabriel<Cdt>>(patch, false);
}

// Limit of steps of a walk, since a longer one costs more than the tree. It also breaks cycles, which are
// possible beside boundary edges, where the triangulation is not Delaunay.
constexpr int kLongestWalk = 100;

/// Returns the boundary edge on which each vertex lies.
std::vector<BackgroundMesh::BoundaryPoint> trace_boundary(const PatchBoundary& patch, const TriPatch& tri) {
  std::vector<int> next(tri.points.size(), -1);
  for (std::size_t t = 0; t < tri.triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      if (tri.neighbours[t][k] < 0) next[tri.triangles[t][(k + 1) % 3]] = tri.triangles[t][(k + 2) % 3];
    }
  }
  std::vector<BackgroundMesh::BoundaryPoint> result(tri.points.size());
  for (const auto& [a, b] : patch.edges) {
    const Vec2 start = patch.points[a], side = patch.points[b] - start;
    const double length = norm(side);
    for (int v = a; v != b; v = next[v]) {
      const double t = norm(tri.points[v] - start) / length;
      result[v] = {patch.point_node[a], patch.point_node[b], t, (1 / length) * side};
    }
  }
  return result;
}

void append(TriPatch& all, const TriPatch& part) {
  const int first_point = static_cast<int>(all.points.size()), first = static_cast<int>(all.triangles.size());
  all.points.insert(all.points.end(), part.points.begin(), part.points.end());
  for (auto v : part.triangles) {
    for (int& i : v) i += first_point;
    all.triangles.push_back(v);
  }
  for (auto n : part.neighbours) {
    for (int& i : n) i = i < 0 ? -1 : i + first;
    all.neighbours.push_back(n);
  }
}

}  // namespace

/// Finds triangles by place, whatever their grading.
class TriangleTree {
 public:
  explicit TriangleTree(const TriPatch& tri) {
    std::vector<Box<Vec2>> boxes;
    boxes.reserve(tri.triangles.size());
    for (const auto& [a, b, c] : tri.triangles)
      boxes.push_back(Box<Vec2>::around({tri.points[a], tri.points[b], tri.points[c]}));
    tree_ = BoxTree<Vec2>(boxes);
  }

  /// Returns the first of the triangles that contain u, sides included (exact); -1: none.
  int containing(const TriPatch& tri, Vec2 u) const {
    int found = -1;
    tree_.nearest(u, 0.0, [&](int t) {
      if ((found < 0 || t < found) && contains(tri, t, u)) found = t;
    });
    return found;
  }

  /// Returns the nearest triangle, the first of several, and its point.
  std::pair<int, Vec2> nearest(const TriPatch& tri, Vec2 u) const {
    std::pair<int, Vec2> best{-1, u};
    double best2 = std::numeric_limits<double>::infinity();
    tree_.nearest(u, best2, [&](int t) {
      const bool inside = contains(tri, t, u);
      for (int k = 0; k < 3; ++k) {
        const auto& v = tri.triangles[t];
        const Vec2 p = inside ? u : nearest_on_segment(u, tri.points[v[k]], tri.points[v[(k + 1) % 3]]);
        const double d2 = dot(p - u, p - u);
        if (best.first >= 0 && d2 >= best2 && (d2 != best2 || t >= best.first)) continue;
        best = {t, p};
        best2 = d2;
      }
    });
    return best;
  }

 private:
  static bool contains(const TriPatch& tri, int t, Vec2 u) {
    const auto& [i, j, k] = tri.triangles[t];
    const Vec2 a = tri.points[i], b = tri.points[j], c = tri.points[k];
    return orient2d(a, b, u) >= 0 && orient2d(b, c, u) >= 0 && orient2d(c, a, u) >= 0;
  }

  BoxTree<Vec2> tree_;
};

BackgroundMesh::BackgroundMesh(std::span<const PatchBoundary> patches) {
  if (patches.empty()) throw InputError("the domain has no patch to mesh: expected at least one region");
  for (std::size_t p = 0; p < patches.size(); ++p) {
    const TriPatch part = refine_patch(patches[p]);
    const auto boundary = trace_boundary(patches[p], part);
    boundary_.insert(boundary_.end(), boundary.begin(), boundary.end());
    append(tri_, part);
    patch_.resize(tri_.triangles.size(), static_cast<int>(p));
  }
  set_up_search();
}

BackgroundMesh::BackgroundMesh(TriPatch triangulation) : tri_(std::move(triangulation)) {
  patch_.resize(tri_.triangles.size(), 0);
  boundary_.resize(tri_.points.size());
  for (std::size_t t = 0; t < tri_.triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      if (tri_.neighbours[t][k] >= 0) continue;
      const int from = tri_.triangles[t][(k + 1) % 3], to = tri_.triangles[t][(k + 2) % 3];
      const Vec2 side = tri_.points[to] - tri_.points[from];
      boundary_[from] = {from, to, 0, (1 / norm(side)) * side};
    }
  }
  set_up_search();
}

void BackgroundMesh::set_up_search() {
  tree_ = std::make_shared<const TriangleTree>(tri_);
  const auto box = Box<Vec2>::around(std::span<const Vec2>(tri_.points));
  reach_ = box.grown(norm(box.size()));
}

/// Returns the nearest point of the reach; NaN becomes its lower end.
Vec2 BackgroundMesh::within_reach(Vec2 u) const {
  const auto clamped = [](double x, double low, double high) { return !(x > low) ? low : std::min(x, high); };
  return {clamped(u.x, reach_.low.x, reach_.high.x), clamped(u.y, reach_.low.y, reach_.high.y)};
}

/// Returns the first triangle that contains u, or -1 if the walk cannot tell: u is outside, on the boundary,
/// at a vertex, or hidden.
int BackgroundMesh::walk(Vec2 u, int hint) const {
  int from = -1, t = hint;
  for (int step = 0; t >= 0 && step < kLongestWalk; ++step) {
    const auto& v = tri_.triangles[t];
    const auto& n = tri_.neighbours[t];
    int zeros = 0, across = 0;
    bool crossed = false;
    for (int k = 0; k < 3 && !crossed; ++k) {
      if (n[k] >= 0 && n[k] == from) continue;
      const int side = orient2d(tri_.points[v[(k + 1) % 3]], tri_.points[v[(k + 2) % 3]], u);
      if (side > 0) continue;
      across = n[k];
      crossed = side < 0;
      zeros += side == 0;
    }
    if (!crossed) {
      if (zeros == 0) return t;
      return zeros == 1 && across >= 0 ? std::min(t, across) : -1;
    }
    from = t;
    t = across;
  }
  return -1;
}

BackgroundMesh::Location BackgroundMesh::locate(Vec2 u, int& hint) const {
  u = within_reach(u);
  int t = walk(u, hint);
  if (t < 0) t = tree_->containing(tri_, u);
  if (t < 0) std::tie(t, u) = tree_->nearest(tri_, u);
  hint = t;

  const auto& v = tri_.triangles[t];
  Location location{t, {1, 0, 0}};
  double area[3], sum = 0;
  for (int k = 0; k < 3; ++k) {
    area[k] = std::max(0.0, cross(tri_.points[v[(k + 1) % 3]] - u, tri_.points[v[(k + 2) % 3]] - u));
    sum += area[k];
  }
  if (sum > 0) {
    for (int k = 0; k < 3; ++k) location.b[k] = area[k] / sum;
  }
  return location;
}

}  // namespace delquad
