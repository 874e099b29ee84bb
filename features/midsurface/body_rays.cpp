// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/midsurface/body_rays.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel_each.h"
#include "base/text.h"
#include "delquad/error.h"
#include "geometry/mesh/half_edges.h"
#include "geometry/mesh/keep_elements.h"

namespace delquad {
namespace {

/// Samples of a large triangle along a side, and of the whole model along a side of its mean extent.
constexpr int kMostAlong = 8;
constexpr double kAlongModel = 60;
/// Distances in diagonals below which a ray has not begun yet.
constexpr double kBegin = 1e-9;
/// Least cosine between the ray and the normal where it leaves the body, for an opposite face.
constexpr double kLeastFacing = 0.5;

/// Returns the distance along a ray to a box; the largest number if it does not meet.
double distance_along(const Vec3& from, const Vec3& along, const Box<Vec3>& box) {
  double first = 0, last = std::numeric_limits<double>::max();
  for (int k = 0; k < 3; ++k) {
    const double x = coordinate(from, k), d = coordinate(along, k);
    const double low = coordinate(box.low, k) - x, high = coordinate(box.high, k) - x;
    if (d == 0) {
      if (low > 0 || high < 0) return std::numeric_limits<double>::infinity();
      continue;
    }
    first = std::max(first, std::min(low / d, high / d));
    last = std::min(last, std::max(low / d, high / d));
  }
  return first <= last ? first : std::numeric_limits<double>::infinity();
}

/// Takes out faces all of whose outline has three triangles or more: two bodies have them in common.
Mesh without_common_faces(Mesh mesh) {
  std::vector<char> branches(mesh.regions.size(), 0), ends(mesh.regions.size(), 0);
  for_each_edge(sorted_half_edges(mesh), [&](std::span<const HalfEdge> edge) {
    const int first = region_of(mesh, edge.front().element), last = region_of(mesh, edge.back().element);
    if (edge.size() == 2 && first == last) return;
    for (const HalfEdge& side : edge) (edge.size() > 2 ? branches : ends)[region_of(mesh, side.element)] = 1;
  });
  keep_triangles(mesh, [&](std::size_t t) {
    return !branches[mesh.triangle_region[t]] || ends[mesh.triangle_region[t]];
  });
  return mesh;
}

}  // namespace

void add_names(const std::vector<std::string>& from, const std::vector<std::string>& others,
               std::vector<std::string>& to) {
  for (const std::string& name : from)
    if (!name.starts_with(kColourName) && std::ranges::find(to, name) == to.end() &&
        std::ranges::find(others, name) == others.end())
      to.push_back(name);
}

BodyRays::BodyRays(const SurfaceModel& model)
    : source(model.source),
      fine(without_common_faces(model.fine)),
      projector(model.projector),
      regions(fine) {
  std::vector<Box<Vec3>> boxes;
  begin = kBegin * diagonal(fine);
  for (const auto& [a, b, c] : fine.triangles) {
    const Vec3 &x = fine.points[a], &y = fine.points[b], &z = fine.points[c];
    boxes.push_back(Box<Vec3>::around({x, y, z}).grown(begin));
    volume += dot(x - fine.points[fine.triangles[0][0]], cross(y - x, z - x)) / 6;
  }
  tree = BoxTree<Vec3>(boxes);
  if (volume < 0) inward_sign = 1, volume = -volume;
  measure_curves();
  sample();
}

Vec3 BodyRays::nearest(int face, const Vec3& x) const {
  return projector ? projector->to_face(face, x) : regions.place(face, x);
}

Vec3 BodyRays::normal(int triangle) const {
  const auto& [a, b, c] = fine.triangles[triangle];
  const Vec3 n = cross(fine.points[b] - fine.points[a], fine.points[c] - fine.points[a]);
  return norm(n) > 0 ? (1 / norm(n)) * n : n;
}

BodyRays::Hit BodyRays::leave(const Vec3& from, const Vec3& along) const {
  constexpr double kRounding = 1e-9;  // of weights
  double limit = std::numeric_limits<double>::max();
  Hit hit;
  tree.search(
      limit, [&](const BoxTree<Vec3>::Node& node) { return distance_along(from, along, node.box); },
      [&](int t) {
        const auto& [a, b, c] = fine.triangles[t];
        const Vec3 u = fine.points[b] - fine.points[a], v = fine.points[c] - fine.points[a];
        const Vec3 n = cross(u, v);
        const double towards = dot(n, along);
        if (!(-inward_sign * towards > 0)) return;
        const Vec3 x = from - fine.points[a];
        const double distance = -dot(n, x) / towards;
        if (!(distance > begin && distance < limit)) return;
        const Vec3 at = x + distance * along;
        const double wu = dot(n, cross(at, v)) / dot(n, n), wv = dot(n, cross(u, at)) / dot(n, n);
        if (wu < -kRounding || wv < -kRounding || wu + wv > 1 + kRounding) return;
        limit = distance;
        hit = {t, distance};
      });
  return hit;
}

BodyRays::Sample BodyRays::look(const Vec3& from, const Vec3& inwards, double area) const {
  const Hit hit = leave(from, inwards);
  if (hit.triangle < 0) return {from, area, -1, std::numeric_limits<double>::infinity()};
  const double facing = -inward_sign * dot(normal(hit.triangle), inwards);
  return {from, area, facing >= kLeastFacing ? fine.triangle_region[hit.triangle] : -1, hit.distance, facing};
}

void BodyRays::measure_curves() {
  shared.resize(fine.regions.size());
  for_each_edge(sorted_half_edges(fine), [&](std::span<const HalfEdge> edge) {
    if (edge.size() != 2)
      throw InputError(fmt::format(
          "{}: the surface is {} at {}: a mid-surface needs closed bodies of one solid each [no-midsurface]",
          source, edge.size() == 1 ? "open" : "branching", show_point(fine.points[edge[0].lo])));
    const int f = region_of(fine, edge[0].element), g = region_of(fine, edge[1].element);
    if (f == g) return;
    const double length = norm(fine.points[edge[0].hi] - fine.points[edge[0].lo]);
    shared[f][g] += length;
    shared[g][f] += length;
  });
}

void BodyRays::sample() {
  const std::size_t n = fine.triangles.size();
  std::vector<std::vector<Sample>> by_triangle(n);
  const auto corner = [&](std::size_t t, int k) { return fine.points[fine.triangles[t][k]]; };
  const auto area = [&](std::size_t t) {
    return norm(cross(corner(t, 1) - corner(t, 0), corner(t, 2) - corner(t, 0))) / 2;
  };
  double total = 0;
  for (std::size_t t = 0; t < n; ++t) total += area(t);
  const double spacing = std::sqrt(total) / kAlongModel;
  parallel_each(n, [&](std::size_t t) {
    double longest = 0;
    for (int k = 0; k < 3; ++k) longest = std::max(longest, norm(corner(t, (k + 1) % 3) - corner(t, k)));
    const int along = std::clamp(static_cast<int>(std::ceil(longest / spacing)), 1, kMostAlong);
    const Vec3 inwards = inward_sign * normal(static_cast<int>(t));
    for (int i = 0; i < along; ++i)
      for (int j = 0; i + j < along; ++j)
        for (const double shift : {1.0 / 3, 2.0 / 3}) {  // triangles that stand up, and down
          const double u = (i + shift) / along, v = (j + shift) / along;
          if (u + v >= 1) continue;
          const Vec3 x = corner(t, 0) + u * (corner(t, 1) - corner(t, 0)) + v * (corner(t, 2) - corner(t, 0));
          by_triangle[t].push_back(look(x, inwards, area(t) / (along * along)));
        }
  });
  samples.resize(fine.regions.size());
  for (std::size_t t = 0; t < n; ++t) {
    std::vector<Sample>& of_face = samples[fine.triangle_region[t]];
    of_face.insert(of_face.end(), by_triangle[t].begin(), by_triangle[t].end());
  }
  for (std::vector<Sample> of_face : samples) {
    std::ranges::sort(of_face, {}, &Sample::distance);
    double half = 0;
    for (const Sample& s : of_face) half += s.area / 2;
    median_thickness.push_back(std::numeric_limits<double>::infinity());
    for (const Sample& s : of_face)
      if ((half -= s.area) <= 0) {
        median_thickness.back() = s.distance;
        break;
      }
  }
}

std::string BodyRays::show(int face) const {
  return fmt::format("face {} at {}", fine.regions[face].tag,
                     show_point(samples[face].empty() ? Vec3{} : samples[face][samples[face].size() / 2].at));
}

}  // namespace delquad
