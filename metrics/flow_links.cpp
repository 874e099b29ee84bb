// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrics/flow_links.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "geometry/mesh/half_edges.h"

namespace delquad {
namespace {

Vec2 middle(Vec2 a, Vec2 b) { return 0.5 * (a + b); }

Vec2 circumcentre(Vec2 a, Vec2 b, Vec2 c) {
  const Vec2 u = b - a, v = c - a;
  const double twice = 2 * cross(u, v);
  return twice == 0 ? (1.0 / 3) * (a + b + c) : a + (1 / twice) * perp(dot(v, v) * u - dot(u, u) * v);
}

/// Returns the center of an element with corners `x`, counterclockwise. `inner` tells whether the edge after
/// each corner has another element.
Vec2 flow_centre(std::span<const Vec2> x, std::span<const char> inner) {
  constexpr int kSteps = 100;
  constexpr double kStep = 0.1;
  const std::size_t n = x.size();
  Vec2 mean;
  for (const Vec2 p : x) mean += (1 / static_cast<double>(n)) * p;
  Vec2 centre = n == 3 ? circumcentre(x[0], x[1], x[2]) : mean;
  if (n == 4 && std::ranges::count(inner, 1) > 1)
    for (int step = 0; step < kSteps; ++step) {
      const Vec2 before = centre;
      for (std::size_t k = 0; k < n; ++k) {
        const Vec2 a = x[k], b = x[(k + 1) % n];
        if (inner[k] != 0)
          centre += (kStep * dot(middle(a, b) - before, b - a) / dot(b - a, b - a)) * (b - a);
      }
    }
  double way = 1;
  for (std::size_t k = 0; k < n; ++k) {
    const Vec2 a = x[k], along = x[(k + 1) % n] - a;
    const double from = cross(along, mean - a), to = cross(along, centre - a);
    if (from > 0 && to < 0) way = std::min(way, from / (from - to));
  }
  return mean + way * (centre - mean);
}

}  // namespace

FlowLinks measure_flow_links(const Mesh& mesh) {
  constexpr double kSmall = 0.1, kOblique = 0.5, kOrthogonal = 0.01;
  const std::vector<HalfEdge> sides = sorted_half_edges(mesh);
  const auto at = [&](int v) { return Vec2{mesh.points[v].x, mesh.points[v].y}; };
  std::vector<Vec2> centres;
  std::vector<double> roots;  // roots of areas
  for_each_element(mesh, [&](int, const auto& v) {
    std::array<Vec2, 4> x;
    std::array<char, 4> inner{};
    double area = 0;
    for (std::size_t k = 0; k < v.size(); ++k) {
      x[k] = at(v[k]);
      const int next = v[(k + 1) % v.size()];
      inner[k] = sides_of_edge(sides, v[k], next).size() > 1;
      area += cross(at(v[k]) - at(v[0]), at(next) - at(v[0])) / 2;
    }
    centres.push_back(flow_centre({x.data(), v.size()}, {inner.data(), v.size()}));
    roots.push_back(std::sqrt(std::max(area, 0.0)));
  });
  FlowLinks result;
  result.least_ratio = std::numeric_limits<double>::infinity();
  double sum = 0;
  int with_length = 0;
  for_each_edge(sides, [&](std::span<const HalfEdge> edge) {
    if (edge.size() != 2) return;
    ++result.links;
    const Vec2 a = at(edge[0].lo), b = at(edge[0].hi);
    const Vec2 link = centres[edge[1].element] - centres[edge[0].element];
    const Place place{{middle(a, b).x, middle(a, b).y, 0}};
    const double ratio = norm(link) / (0.5 * (roots[edge[0].element] + roots[edge[1].element]));
    if (ratio < kSmall) ++result.small;
    if (ratio < result.least_ratio) result.least_ratio = ratio, result.shortest = place;
    if (link == Vec2{}) return;
    const double cosine = std::abs(dot(link, b - a)) / (norm(link) * norm(b - a));
    ++with_length;
    sum += cosine;
    if (cosine > kOblique) ++result.oblique;
    if (cosine < kOrthogonal) ++result.orthogonal;
    if (cosine > result.cos_max) result.cos_max = cosine, result.worst = place;
  });
  if (with_length > 0) result.cos_mean = sum / with_length;
  return result;
}

}  // namespace delquad
