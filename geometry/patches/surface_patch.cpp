// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "geometry/mesh/triangle_measures.h"
#include "geometry/patches/surface_domain.h"

namespace delquad {

namespace {

std::array<int, 3> nodes_of(const SurfacePatch& patch, const std::array<int, 3>& v) {
  const std::vector<int>& node = patch.map.fine_node;
  return {node[v[0]], node[v[1]], node[v[2]]};
}

}  // namespace

std::vector<double> stretch_of(const FlatPatch& map, const Mesh& fine) {
  const TriPatch& flat = map.flat;
  std::vector<double> flat_area(flat.points.size(), 0), area(flat.points.size(), 0), stretch;
  for (size_t t = 0; t < flat.triangles.size(); ++t) {
    const double in_plane = area_vector(flat.points, flat.triangles[t]);
    const double in_space = double_area(map, fine, t);
    for (const int i : flat.triangles[t]) flat_area[i] += in_plane, area[i] += in_space;
  }
  for (size_t i = 0; i < area.size(); ++i)
    stretch.push_back(area[i] > 0 ? std::sqrt(flat_area[i] / area[i]) : 1);
  return stretch;
}

SurfacePatchSize::SurfacePatchSize(const SurfacePatch& patch, const Mesh& fine, const SurfaceSize& size)
    : patch_(patch), fine_(fine), size_(size), stretch_(stretch_of(patch.map, fine)) {}

double SurfacePatchSize::at(Vec2 u, int& hint) const {
  const auto [t, b] = patch_.background->locate(u, hint);
  const auto& v = patch_.map.flat.triangles[t];
  std::array<int, 3> nodes;
  Vec3 x;
  double stretch = 0, limit = 0;
  for (int k = 0; k < 3; ++k) {
    nodes[k] = patch_.map.fine_node[v[k]];
    if (!patch_.tube_size.empty()) limit += b[k] * patch_.tube_size[v[k]];
    x = x + b[k] * fine_.points[nodes[k]];
    stretch += b[k] * stretch_[v[k]];
  }
  int size_hint = -1;
  const double wanted = size_.on_fine(nodes, b, x, size_hint);
  return stretch * (patch_.tube_size.empty() ? wanted : std::min(wanted, limit));
}

Vec3 fine_place(const SurfacePatch& patch, const Mesh& fine, Vec2 u, int& hint) {
  const auto [t, b] = patch.background->locate(u, hint);
  const auto& v = patch.map.flat.triangles[t];
  Vec3 x;
  for (int k = 0; k < 3; ++k) x = x + b[k] * fine.points[patch.map.fine_node[v[k]]];
  return x;
}

std::array<Vec3, 2> tangents(const SurfacePatch& patch, const Mesh& fine, int triangle) {
  const auto& v = patch.map.flat.triangles[triangle];
  const auto& u = patch.map.flat.points;
  const auto x = [&](int k) { return fine.points[patch.map.fine_node[v[k]]]; };
  const Vec2 a = u[v[1]] - u[v[0]], b = u[v[2]] - u[v[0]];
  const Vec3 p = x(1) - x(0), q = x(2) - x(0);
  const double inverse = 1 / cross(a, b);
  return {inverse * (b.y * p - a.y * q), inverse * (a.x * q - b.x * p)};
}

Vec3 fine_normal(const SurfacePatch& patch, const Mesh& fine, Vec2 u, int& hint) {
  const TriPatch& flat = patch.map.flat;
  std::vector<int> around{patch.background->locate(u, hint).triangle};
  for (int ring = 0; ring < 2; ++ring)
    for (size_t i = around.size(); i-- > 0;)
      for (const int t : flat.neighbours[around[i]])
        if (t >= 0 && std::ranges::find(around, t) == around.end()) around.push_back(t);
  Vec3 sum;
  for (const int t : around) sum = sum + area_vector(fine.points, nodes_of(patch, flat.triangles[t]));
  return sum;
}

Vec3 lift(const SurfacePatch& patch, const SurfaceModel& model, Vec2 u, int& hint) {
  const Vec3 x = fine_place(patch, model.fine, u, hint);
  return model.projector ? model.projector->to_face(patch.map.face, x) : x;
}

}  // namespace delquad
