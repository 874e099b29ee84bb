// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesher/cross_in_space.h"

#include <cmath>
#include <memory>

#include "base/parallel.h"
#include "delquad/mesher.h"
#include "features/metric/metric_surface.h"
#include "geometry/mesh/half_edges.h"
#include "geometry/mesh/nearest_triangle.h"

namespace delquad {
namespace {

CrossInSpace in_plane(const MeshingSetup& prepared) {
  return [&](const Vec3& x, double reach, int& hint) -> std::optional<std::array<Vec3, 2>> {
    const BackgroundMesh& background = *prepared.plane.background;
    const auto [t, b] = background.locate({x.x, x.y}, hint);
    const TriPatch& tri = background.triangles();
    const auto& v = tri.triangles[t];
    const Vec2 u = b[0] * tri.points[v[0]] + b[1] * tri.points[v[1]] + b[2] * tri.points[v[2]];
    if (norm(u - Vec2{x.x, x.y}) > reach) return std::nullopt;
    int anywhere = -1;
    const double angle = prepared.patches[background.triangle_patch()[t]].cross->at(u, anywhere).angle();
    const double c = std::cos(angle), s = std::sin(angle);
    return std::array{Vec3{c, s, 0}, Vec3{-s, c, 0}};
  };
}

/// All maps of a surface, and the places of their triangles in space.
struct Maps {
  std::vector<std::array<std::size_t, 2>> origins;  ///< of each triangle the patch and its number there
  std::unique_ptr<const NearestTriangle> nearest;
};

CrossInSpace on_surface(const MeshingSetup& prepared) {
  const auto maps = std::make_shared<Maps>();
  const SurfaceSetup& surface = *prepared.surface;
  std::vector<std::array<int, 3>> triangles;
  for (std::size_t p = 0; p < prepared.patches.size(); ++p) {
    const FlatPatch& map = surface.domain.patches[p].map;
    for (std::size_t t = 0; t < map.flat.triangles.size(); ++t) {
      const auto& v = map.flat.triangles[t];
      triangles.push_back({map.fine_node[v[0]], map.fine_node[v[1]], map.fine_node[v[2]]});
      maps->origins.push_back({p, t});
    }
  }
  if (triangles.empty()) return nullptr;
  maps->nearest = std::make_unique<NearestTriangle>(surface.model.fine.points, std::move(triangles));
  return [&, maps](const Vec3& x, double reach, int& hint) -> std::optional<std::array<Vec3, 2>> {
    const NearestTriangle::Found found = maps->nearest->find_from(hint, x);
    if (found.triangle < 0 || !(found.distance <= reach)) return std::nullopt;
    hint = found.triangle;
    const auto [patch, t] = maps->origins[found.triangle];
    const FlatPatch& map = surface.domain.patches[patch].map;
    const auto& v = map.flat.triangles[t];
    const auto& at = map.flat.points;
    const std::array<double, 3>& b = found.weights;
    int anywhere = -1;
    const double angle = prepared.patches[patch]
                             .cross->at(b[0] * at[v[0]] + b[1] * at[v[1]] + b[2] * at[v[2]], anywhere)
                             .angle();
    // Coordinates by two sides of the triangle, which are the same in space.
    const Vec2 p = at[v[1]] - at[v[0]], q = at[v[2]] - at[v[0]];
    const double area = cross(p, q);
    const auto& points = surface.model.fine.points;
    const Vec3 &a = points[map.fine_node[v[0]]], side = points[map.fine_node[v[1]]] - a,
               other = points[map.fine_node[v[2]]] - a;
    const auto in_space = [&](const Vec2& d) {
      return (cross(d, q) / area) * side + (cross(p, d) / area) * other;
    };
    const double c = std::cos(angle), s = std::sin(angle);
    return std::array{in_space({c, s}), in_space({-s, c})};
  };
}

}  // namespace

CrossInSpace cross_in_space(const MeshingSetup& prepared) {
  if (prepared.surface) return prepared.surface->metric ? nullptr : on_surface(prepared);
  return prepared.metric_plane || !prepared.plane.background ? nullptr : in_plane(prepared);
}

WantedAt wanted_at(const Prepared& prepared, const Mesh& mesh) {
  const std::size_t n = mesh.points.size();
  WantedAt wanted{std::vector<double>(n), std::vector<std::array<Vec3, 2>>(n)};
  const MetricAt metric = metric_of(prepared.inside());
  const CrossInSpace cross = cross_in_space(prepared.inside());
  std::vector<int> region(n, 0);
  for_each_element(mesh, [&](int e, const auto& v) {
    for (const int i : v) region[i] = region_of(mesh, e);
  });
  parallel_ranges(n, [&](std::size_t begin, std::size_t end) {
    int in_size = -1, in_field = -1;
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3& x = mesh.points[i];
      auto& [first, second] = wanted.edges[i];
      if (metric) {
        const TangentMetric m = metric(region[i], x, in_field);
        const MetricAxes axes = axes_of(m.m);
        const double c = std::cos(axes.theta), s = std::sin(axes.theta);
        first = axes.h1 * m.in_space({c, s});
        second = axes.h2 * m.in_space({-s, c});
        wanted.size[i] = std::sqrt(axes.h1 * axes.h2);
        continue;
      }
      const double size = wanted.size[i] = prepared->size.field->at(x, in_size);
      if (const auto ways = cross ? cross(x, size, in_field) : std::nullopt) {
        first = size / norm((*ways)[0]) * (*ways)[0];
        second = size / norm((*ways)[1]) * (*ways)[1];
      }
    }
  });
  return wanted;
}

}  // namespace delquad
