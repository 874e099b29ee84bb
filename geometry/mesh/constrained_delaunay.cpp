// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/mesh/constrained_delaunay.h"

#include <fmt/format.h>

#include "delquad/error.h"
#include "geometry/mesh/patch_cdt.h"

namespace delquad {

namespace {

using FaceBase = CGAL::Constrained_triangulation_face_base_2<patch_cdt::Kernel, patch_cdt::FaceBase>;
using Structure = CGAL::Triangulation_data_structure_2<patch_cdt::VertexBase, FaceBase>;
using Cdt = CGAL::Constrained_Delaunay_triangulation_2<patch_cdt::Kernel, Structure,
                                                       CGAL::No_constraint_intersection_tag>;

}  // namespace

TriPatch constrained_delaunay(const PatchBoundary& boundary, const std::vector<Vec2>& interior) {
  TriPatch tri;
  tri.points = boundary.points;
  tri.points.insert(tri.points.end(), interior.begin(), interior.end());
  tri.n_boundary = static_cast<int>(boundary.points.size());

  Cdt cdt;
  const auto vertex = patch_cdt::insert(cdt, boundary, tri.points);
  const auto inside = patch_cdt::number_inside(cdt, boundary, vertex);
  std::vector<char> used(tri.points.size(), 0);
  tri.triangles.reserve(inside.size());
  tri.neighbours.reserve(inside.size());
  for (const auto& f : inside) {
    auto& v = tri.triangles.emplace_back();
    auto& n = tri.neighbours.emplace_back();
    for (int k = 0; k < 3; ++k) {
      v[k] = f->vertex(k)->info().value;
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

}  // namespace delquad
