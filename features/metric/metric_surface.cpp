// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/metric/metric_surface.h"

#include <cmath>

#include "features/metric/metric_plane.h"

namespace delquad {

WantedMetric wanted_metric(const MeshProblem& problem, const SurfaceModel& model,
                           const std::vector<SizeBall>& spots) {
  return {problem.metric, std::make_shared<ModelCurvature>(model), spots};
}

Flattening flatten_by_metric(SurfaceModel& model, const SurfaceMetric& metric) {
  // Where lengths along the axes differ much, so does the scale of a map.
  constexpr double kMaxAreaRatio = 100;
  FlattenOptions options;
  options.max_area_ratio = kMaxAreaRatio;
  options.length = [&](int face, int a, int b) { return metric.length(model.fine, face, a, b); };
  return flatten(model, options);
}

CrossPull pull_at(const SurfaceSetup& surface, int patch, Vec2 u, int& hint) {
  const FlatPatch& map = surface.domain.patches[patch].map;
  const Mesh& fine = surface.model.fine;
  const auto [t, b] = surface.domain.patches[patch].background->locate(u, hint);
  const auto& v = map.flat.triangles[t];
  std::array<TangentMetric, 3> corners;
  std::array<Vec3, 3> x;
  for (int k = 0; k < 3; ++k) {
    corners[k] = surface.metric->at_node(fine, map.face, map.fine_node[v[k]]);
    x[k] = fine.points[map.fine_node[v[k]]];
  }
  const TangentMetric metric = log_mean(corners, b);
  const MetricAxes axes = axes_of(metric.m);
  const Vec3 along = metric.in_space({std::cos(axes.theta), std::sin(axes.theta)});
  // In the terms of two sides of the triangle, which are the sides of its image.
  const Vec3 p = x[1] - x[0], q = x[2] - x[0], area = cross(p, q);
  const double of_p = dot(cross(along, q), area), of_q = dot(cross(p, along), area);
  const auto& at = map.flat.points;
  return pull_to(of_p * (at[v[1]] - at[v[0]]) + of_q * (at[v[2]] - at[v[0]]), axes);
}

double scale_of(const MeshingSetup& prepared) {
  return prepared.metric_plane->scale_of(prepared.size.asked ? *prepared.size.asked : *prepared.size.field);
}

MetricAt metric_of(const MeshingSetup& prepared) {
  if (prepared.surface && prepared.surface->metric)
    return [metric = prepared.surface->metric](int region, const Vec3& x, int&) {
      return metric->in_face(region, x);
    };
  if (!prepared.metric_plane) return nullptr;
  const MetricPlane& plane = *prepared.metric_plane;
  const double scale = scale_of(prepared);
  return [&plane, factor = 1 / (scale * scale)](int, const Vec3& x, int& hint) {
    const Tensor2 m = plane.metric_at({x.x, x.y}, hint);
    return TangentMetric{.m = {factor * m.xx, factor * m.xy, factor * m.yy}};
  };
}

}  // namespace delquad
