#include <algorithm>
#include <cmath>

#include "patches/surface_domain.h"

namespace delquad {

SurfacePatchSize::SurfacePatchSize(const SurfacePatch& patch, const Mesh& fine, const SurfaceSize& size)
    : patch_(patch), fine_(fine), size_(size) {
  const TriPatch& flat = patch.map.flat;
  std::vector<double> flat_area(flat.points.size(), 0), area(flat.points.size(), 0);
  for (const auto& v : flat.triangles) {
    const Vec3 a = fine.points[patch.map.fine_node[v[0]]], b = fine.points[patch.map.fine_node[v[1]]],
               c = fine.points[patch.map.fine_node[v[2]]];
    const double in_plane =
        cross(flat.points[v[1]] - flat.points[v[0]], flat.points[v[2]] - flat.points[v[0]]);
    const double in_space = norm(cross(b - a, c - a));
    for (const int i : v) flat_area[i] += in_plane, area[i] += in_space;
  }
  for (size_t i = 0; i < area.size(); ++i)
    stretch_.push_back(area[i] > 0 ? std::sqrt(flat_area[i] / area[i]) : 1);
}

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

Vec3 fine_normal(const SurfacePatch& patch, const Mesh& fine, Vec2 u, int& hint) {
  const TriPatch& flat = patch.map.flat;
  std::vector<int> around{patch.background->locate(u, hint).triangle};
  for (int ring = 0; ring < 2; ++ring)
    for (size_t i = around.size(); i-- > 0;)
      for (const int t : flat.neighbours[around[i]])
        if (t >= 0 && std::ranges::find(around, t) == around.end()) around.push_back(t);
  Vec3 sum;
  for (const int t : around) {
    const auto x = [&](int k) { return fine.points[patch.map.fine_node[flat.triangles[t][k]]]; };
    sum = sum + cross(x(1) - x(0), x(2) - x(0));
  }
  return sum;
}

Vec3 lift(const SurfacePatch& patch, const SurfaceModel& model, Vec2 u, int& hint) {
  const Vec3 x = fine_place(patch, model.fine, u, hint);
  return model.projector ? model.projector->to_face(patch.map.face, x) : x;
}

}  // namespace delquad
