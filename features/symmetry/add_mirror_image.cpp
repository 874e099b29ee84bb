// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/symmetry/symmetry_planes.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/text.h"
#include "delquad/error.h"
#include "geometry/mesh/half_edges.h"
#include "geometry/mesh/keep_elements.h"

namespace delquad {

namespace {

void check_one_side(const std::vector<Vec3>& points, const std::vector<double>& height, double tolerance,
                    const std::string& source) {
  const auto [low, high] = std::minmax_element(height.begin(), height.end());
  if (-*low <= tolerance || *high <= tolerance) return;
  throw InputError(
      fmt::format("{}: the model lies on both sides of the mirror's plane: {} is {:.3g} before and {} {:.3g} "
                  "behind it: expected half a model, or a larger tolerance",
                  source, show_point(points[high - height.begin()]), *high,
                  show_point(points[low - height.begin()]), -*low));
}

/// Whether each point is an end of an open edge within the tolerance.
std::vector<char> points_of_both(const Mesh& half, const std::vector<double>& height, double tolerance) {
  std::vector<char> both(half.points.size(), 0);
  const std::vector<HalfEdge> sides = sorted_half_edges(half);
  for_each_edge(sides, [&](std::span<const HalfEdge> edge) {
    if (edge.size() != 1) return;
    for (const int p : {edge[0].lo, edge[0].hi}) both[p] = both[p] || std::abs(height[p]) <= tolerance;
  });
  return both;
}

/// Appends regions for the other half, with new tags; returns how many there were.
int double_regions(Mesh& mesh) {
  const int n = static_cast<int>(mesh.regions.size());
  int last = 0;
  for (const Entity& region : mesh.regions) last = std::max(last, region.tag);
  for (int i = 0; i < n; ++i) {
    Entity other = mesh.regions[i];
    other.tag = ++last;
    mesh.regions.push_back(std::move(other));
  }
  return n;
}

}  // namespace

Mesh add_mirror_image(Mesh half, const MirrorPlane& plane, const std::string& source) {
  const double tolerance = plane.tolerance * diagonal(half);
  const Vec3 normal = (1 / norm(plane.normal)) * plane.normal;
  std::vector<double> height;
  for (const Vec3& p : half.points) height.push_back(dot(normal, p - plane.point));
  check_one_side(half.points, height, tolerance, source);
  const std::vector<char> both = points_of_both(half, height, tolerance);
  if (std::find(both.begin(), both.end(), 1) == both.end())
    throw InputError(fmt::format(
        "{}: no open edge lies within {:.3g} of the mirror's plane: expected half a model, open there",
        source, tolerance));
  keep_lines(half, [&](size_t i) { return !both[half.lines[i][0]] || !both[half.lines[i][1]]; });

  const int offset = plane.join ? 0 : double_regions(half);
  std::vector<int> image;
  const size_t n_points = half.points.size(), n_lines = half.lines.size(),
               n_triangles = half.triangles.size();
  for (size_t i = 0; i < n_points; ++i) {
    if (both[i]) {
      half.points[i] = half.points[i] - height[i] * normal;
      image.push_back(static_cast<int>(i));
    } else {
      image.push_back(static_cast<int>(half.points.size()));
      half.points.push_back(half.points[i] - 2 * height[i] * normal);
    }
  }
  for (size_t i = 0; i < n_lines; ++i) {
    half.lines.push_back({image[half.lines[i][0]], image[half.lines[i][1]]});
    half.line_curve.push_back(int(half.line_curve[i]));
  }
  for (size_t t = 0; t < n_triangles; ++t) {
    const auto [a, b, c] = half.triangles[t];
    if (both[a] && both[b] && both[c])
      throw InputError(fmt::format(
          "{}: the triangle at {} lies in the mirror's plane: expected a model without a wall there", source,
          show_point(half.points[a])));
    half.triangles.push_back({image[a], image[c], image[b]});
    half.triangle_region.push_back(half.triangle_region[t] + offset);
  }
  return half;
}

}  // namespace delquad
