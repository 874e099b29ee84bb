#include <cmath>

#include "geometry/surface/conformal_maps.h"

namespace delquad {

std::optional<std::vector<Vec2>> planar_map(const Chart& chart, double tolerance) {
  auto double_area = [&](const std::array<int, 3>& v) {
    return cross(chart.points[v[1]] - chart.points[v[0]], chart.points[v[2]] - chart.points[v[0]]);
  };
  Vec3 normal;
  for (const auto& v : chart.triangles) normal = normal + double_area(v);
  if (norm(normal) == 0) return std::nullopt;
  normal = (1 / norm(normal)) * normal;
  const Vec3 origin = chart.points[0];
  for (const Vec3& p : chart.points)
    if (std::abs(dot(p - origin, normal)) > tolerance) return std::nullopt;
  for (const auto& v : chart.triangles)
    if (dot(double_area(v), normal) <= 0) return std::nullopt;

  const Vec3 axis = std::abs(normal.x) < 0.9 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  Vec3 e1 = axis - dot(axis, normal) * normal;
  e1 = (1 / norm(e1)) * e1;
  const Vec3 e2 = cross(normal, e1);
  std::vector<Vec2> flat;
  for (const Vec3& p : chart.points) flat.push_back({dot(p - origin, e1), dot(p - origin, e2)});
  return flat;
}

}  // namespace delquad
