// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "delquad/error.h"
#include "delquad/mesh.h"

// This header puts patches into CGAL's constrained Delaunay triangulations `Cdt`, whose vertices and faces
// are numbered. Triangulations and background meshes use it.
namespace delquad::patch_cdt {

struct VertexNumber {
  int value = -1;  ///< index of a given point; -1: none
};
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<VertexNumber, Kernel>;
using FaceBase = CGAL::Triangulation_face_base_with_info_2<int, Kernel>;
constexpr int kOutside = -1;

/// Inserts points, points of the boundary first, and the boundary's edges. Returns the vertices of the
/// points. Throws InputError if points coincide, or edges cross or pass through points.
template <class Cdt>
std::vector<typename Cdt::Vertex_handle> insert(Cdt& cdt, const PatchBoundary& boundary,
                                                const std::vector<Vec2>& points) {
  std::vector<std::pair<Kernel::Point_2, VertexNumber>> numbered;
  for (const Vec2 p : points) numbered.push_back({{p.x, p.y}, {static_cast<int>(numbered.size())}});
  cdt.insert(numbered.begin(), numbered.end());
  std::vector<typename Cdt::Vertex_handle> vertex(points.size());
  for (auto v = cdt.finite_vertices_begin(); v != cdt.finite_vertices_end(); ++v) vertex[v->info().value] = v;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (vertex[i] == nullptr)
      throw InputError(fmt::format("two points of a patch coincide at ({}, {})", points[i].x, points[i].y));
  for (const auto& [i, j] : boundary.edges) {
    const Vec2 a = points[i], b = points[j];
    typename Cdt::Face_handle face;
    int side = 0;
    if (cdt.dimension() == 2 && cdt.is_edge(vertex[i], vertex[j], face, side) && face->is_constrained(side) &&
        std::ranges::find(boundary.edges, std::array{j, i}) != boundary.edges.end())
      continue;  // the other side of a slit
    try {
      cdt.insert_constraint(vertex[i], vertex[j]);
    } catch (const typename Cdt::Intersection_of_constraints_exception&) {
      throw InputError(
          fmt::format("the boundary crosses itself on the edge ({}, {}) - ({}, {}) [crossing-curves]", a.x,
                      a.y, b.x, b.y));
    }
    if (!cdt.is_edge(vertex[i], vertex[j]))
      throw InputError(fmt::format("the boundary passes through a point at ({}, {})", a.x, a.y));
  }
  return vertex;
}

/// Numbers the faces inside the patch by flooding from the left of its boundary edges, and returns them.
/// Other faces get kOutside. Throws InputError if the inside is unbounded, or lies also on the right of an
/// edge that is no slit.
template <class Cdt>
std::vector<typename Cdt::Face_handle> number_inside(Cdt& cdt, const PatchBoundary& boundary,
                                                     const std::vector<typename Cdt::Vertex_handle>& vertex) {
  using Face = typename Cdt::Face_handle;
  for (auto f = cdt.all_faces_begin(); f != cdt.all_faces_end(); ++f) f->info() = kOutside;
  std::vector<Face> inside;
  const auto enter = [&](Face f) {
    if (cdt.is_infinite(f)) {
      const Vec2 at = boundary.points[boundary.edges[0][0]];
      throw InputError(
          fmt::format("the boundary is turned inside out at ({}, {}): the patch has no end", at.x, at.y));
    }
    if (f->info() != kOutside) return;
    f->info() = static_cast<int>(inside.size());
    inside.push_back(f);
  };
  const auto face_beside = [&](int a, int b) {
    Face f;
    int side = 0;
    cdt.is_edge(vertex[a], vertex[b], f, side);
    // The face to the left of the edge sees its ends in counterclockwise order.
    return f->vertex(Cdt::ccw(side)) == vertex[a] ? f : f->neighbor(side);
  };
  for (const auto& [a, b] : boundary.edges) enter(face_beside(a, b));
  for (std::size_t i = 0; i < inside.size(); ++i)
    for (int k = 0; k < 3; ++k)
      if (!inside[i]->is_constrained(k)) enter(inside[i]->neighbor(k));
  for (const auto& [a, b] : boundary.edges) {
    if (face_beside(b, a)->info() == kOutside) continue;
    if (std::ranges::find(boundary.edges, std::array{b, a}) != boundary.edges.end()) continue;  // a slit
    const Vec2 p = boundary.points[a], q = boundary.points[b];
    throw InputError(
        fmt::format("the boundary is turned inside out at the edge ({}, {}) - ({}, {}): the patch lies on "
                    "both sides of it",
                    p.x, p.y, q.x, q.y));
  }
  return inside;
}

}  // namespace delquad::patch_cdt
