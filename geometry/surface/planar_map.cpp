// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "geometry/mesh/triangle_measures.h"
#include "geometry/surface/conformal_maps.h"

namespace delquad {

namespace {

/// Move of each side of a slit, over the shorter line beside.
constexpr double kOpening = 1e-4;

/// Opens slits, lines with the chart on both sides: coinciding vertices move a little into their own sectors.
void open_slits(const Chart& chart, std::vector<Vec2>& flat) {
  std::vector<std::pair<int, int>> by_node;  // fine node, vertex
  for (int v = 0; v < chart.n_boundary; ++v) by_node.emplace_back(chart.fine_node[v], v);
  std::ranges::sort(by_node);
  std::vector<char> doubled(chart.n_boundary, 0);
  for (std::size_t i = 1; i < by_node.size(); ++i)
    if (by_node[i].first == by_node[i - 1].first)
      doubled[by_node[i].second] = doubled[by_node[i - 1].second] = 1;
  const std::vector<Vec2> closed = flat;
  for (const auto& loop : chart.loops)
    for (std::size_t k = 0; k < loop.size(); ++k) {
      if (!doubled[loop[k]]) continue;
      const Vec2 in = closed[loop[k]] - closed[loop[(k + loop.size() - 1) % loop.size()]];
      const Vec2 out = closed[loop[(k + 1) % loop.size()]] - closed[loop[k]];
      const Vec2 inward = (1 / norm(in)) * perp(in) + (1 / norm(out)) * perp(out);
      if (norm(inward) > 0) flat[loop[k]] += kOpening * std::min(norm(in), norm(out)) / norm(inward) * inward;
    }
}

}  // namespace

std::optional<std::vector<Vec2>> planar_map(const Chart& chart, double tolerance) {
  Vec3 normal;
  for (const auto& v : chart.triangles) normal = normal + area_vector(chart.points, v);
  if (norm(normal) == 0) return std::nullopt;
  normal = (1 / norm(normal)) * normal;
  const Vec3 origin = chart.points[0];
  for (const Vec3& p : chart.points)
    if (std::abs(dot(p - origin, normal)) > tolerance) return std::nullopt;
  for (const auto& v : chart.triangles)
    if (dot(area_vector(chart.points, v), normal) <= 0) return std::nullopt;

  const Vec3 axis = std::abs(normal.x) < 0.9 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  Vec3 e1 = axis - dot(axis, normal) * normal;
  e1 = (1 / norm(e1)) * e1;
  const Vec3 e2 = cross(normal, e1);
  std::vector<Vec2> flat;
  for (const Vec3& p : chart.points) flat.push_back({dot(p - origin, e1), dot(p - origin, e2)});
  open_slits(chart, flat);
  return flat;
}

}  // namespace delquad
