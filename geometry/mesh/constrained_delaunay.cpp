#include "geometry/mesh/constrained_delaunay.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "base/predicates.h"
#include "delquad/error.h"

namespace delquad {

namespace {

constexpr int kOutside = -1;

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<int, Kernel>;
using FaceBase =
    CGAL::Constrained_triangulation_face_base_2<Kernel,
                                                CGAL::Triangulation_face_base_with_info_2<int, Kernel>>;
using Structure = CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>;
using Cdt =
    CGAL::Constrained_Delaunay_triangulation_2<Kernel, Structure, CGAL::No_constraint_intersection_tag>;

std::vector<Cdt::Vertex_handle> insert_points(Cdt& cdt, const std::vector<Vec2>& points) {
  std::vector<std::pair<Kernel::Point_2, int>> tagged;
  tagged.reserve(points.size());
  for (size_t i = 0; i < points.size(); ++i)
    tagged.emplace_back(Kernel::Point_2(points[i].x, points[i].y), i);
  cdt.insert(tagged.begin(), tagged.end());
  std::vector<Cdt::Vertex_handle> handle(points.size());
  for (auto v = cdt.finite_vertices_begin(); v != cdt.finite_vertices_end(); ++v) handle[v->info()] = v;
  for (size_t i = 0; i < points.size(); ++i) {
    if (handle[i] == nullptr) {
      throw InputError(fmt::format("two points of a patch coincide at ({}, {})", points[i].x, points[i].y));
    }
  }
  return handle;
}

/// Numbers the faces inside the patch, flooding from the left sides of its boundary edges; returns these.
/// Refuses edges, but for slits, that have the inside on their right, too, and an inside without end: of
/// loops turned inside out.
std::vector<Cdt::Face_handle> flood_inside(Cdt& cdt, const PatchBoundary& boundary,
                                           const std::vector<Cdt::Vertex_handle>& handle) {
  for (auto f = cdt.all_faces_begin(); f != cdt.all_faces_end(); ++f) f->info() = kOutside;
  std::vector<Cdt::Face_handle> inside;
  bool has_end = true;
  const auto enter = [&](Cdt::Face_handle f) {
    has_end &= !cdt.is_infinite(f);
    if (f->info() != kOutside || cdt.is_infinite(f)) return;
    f->info() = static_cast<int>(inside.size());
    inside.push_back(f);
  };
  std::vector<std::pair<Cdt::Face_handle, std::size_t>> right;  // with its edge
  for (std::size_t i = 0; i < boundary.edges.size(); ++i) {
    const auto& e = boundary.edges[i];
    Cdt::Face_handle f;
    int side = 0;
    if (!cdt.is_edge(handle[e[0]], handle[e[1]], f, side)) {
      throw InputError(fmt::format("the boundary passes through a point at ({}, {})", boundary.points[e[0]].x,
                                   boundary.points[e[0]].y));
    }
    // The face to the left of the edge sees its ends in counterclockwise order.
    const bool is_left = f->vertex(Cdt::ccw(side)) == handle[e[0]];
    enter(is_left ? f : f->neighbor(side));
    right.emplace_back(is_left ? f->neighbor(side) : f, i);
  }
  for (size_t i = 0; i < inside.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      if (!inside[i]->is_constrained(k)) enter(inside[i]->neighbor(k));
    }
  }
  if (!has_end) {
    const Vec2 at = boundary.points[boundary.edges[0][0]];
    throw InputError(
        fmt::format("the boundary is turned inside out at ({}, {}): the patch has no end", at.x, at.y));
  }
  for (const auto& [face, i] : right) {
    if (face->info() == kOutside) continue;
    const auto [from, to] = boundary.edges[i];
    if (std::ranges::find(boundary.edges, std::array{to, from}) != boundary.edges.end()) continue;  // a slit
    const Vec2 a = boundary.points[from], b = boundary.points[to];
    throw InputError(
        fmt::format("the boundary is turned inside out at the edge ({}, {}) - ({}, {}): the patch lies on "
                    "both sides of it",
                    a.x, a.y, b.x, b.y));
  }
  return inside;
}

}  // namespace

TriPatch constrained_delaunay(const PatchBoundary& boundary, const std::vector<Vec2>& interior) {
  TriPatch tri;
  tri.points = boundary.points;
  tri.points.insert(tri.points.end(), interior.begin(), interior.end());
  tri.n_boundary = static_cast<int>(boundary.points.size());

  Cdt cdt;
  const auto handle = insert_points(cdt, tri.points);
  for (const auto& e : boundary.edges) {
    try {
      cdt.insert_constraint(handle[e[0]], handle[e[1]]);
    } catch (const Cdt::Intersection_of_constraints_exception&) {
      const Vec2 a = tri.points[e[0]], b = tri.points[e[1]];
      throw InputError(
          fmt::format("the boundary crosses itself on the edge ({}, {}) - ({}, {})", a.x, a.y, b.x, b.y));
    }
  }
  const auto inside = flood_inside(cdt, boundary, handle);
  std::vector<char> used(tri.points.size(), 0);
  tri.triangles.reserve(inside.size());
  tri.neighbours.reserve(inside.size());
  for (const auto& f : inside) {
    auto& v = tri.triangles.emplace_back();
    auto& n = tri.neighbours.emplace_back();
    for (int k = 0; k < 3; ++k) {
      v[k] = f->vertex(k)->info();
      used[v[k]] = 1;
      n[k] = f->is_constrained(k) ? -1 : f->neighbor(k)->info();
    }
  }
  for (size_t i = 0; i < used.size(); ++i) {
    if (!used[i]) {
      throw InputError(
          fmt::format("point ({}, {}) lies outside the patch", tri.points[i].x, tri.points[i].y));
    }
  }
  return tri;
}

std::vector<std::string> check_invariants(const TriPatch& tri) {
  std::vector<std::string> wrong;
  const int n_points = static_cast<int>(tri.points.size()), n = static_cast<int>(tri.triangles.size());
  for (int t = 0; t < n; ++t) {
    const auto& v = tri.triangles[t];
    bool in_range = true;
    for (int k = 0; k < 3; ++k)
      in_range = in_range && v[k] >= 0 && v[k] < n_points && tri.neighbours[t][k] < n;
    if (!in_range) {
      wrong.push_back(fmt::format("triangle {}: an index is out of range", t));
      continue;
    }
    if (orient2d(tri.points[v[0]], tri.points[v[1]], tri.points[v[2]]) <= 0) {
      wrong.push_back(fmt::format("triangle {}: not counterclockwise", t));
    }
    for (int k = 0; k < 3; ++k) {
      const int o = tri.neighbours[t][k];
      if (o < 0) continue;
      bool mutual = false;
      for (int j = 0; j < 3; ++j) {
        mutual = mutual || (tri.neighbours[o][j] == t && tri.triangles[o][(j + 1) % 3] == v[(k + 2) % 3] &&
                            tri.triangles[o][(j + 2) % 3] == v[(k + 1) % 3]);
      }
      if (!mutual) wrong.push_back(fmt::format("triangles {} and {}: neighbours that do not agree", t, o));
    }
  }
  return wrong;
}

}  // namespace delquad
