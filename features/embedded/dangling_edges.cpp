// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/embedded/dangling_edges.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/segment.h"
#include "base/text.h"
#include "delquad/error.h"

namespace delquad {
namespace {

constexpr int kDanglingDirections = 8;  // of a line
constexpr double kDanglingShorter = 0.7, kShortestDangling = 1e-3;
/// Places along a dangling curve, by their part of its length, keep away from all else by this part of their
/// way.
constexpr int kDanglingPlaces = 6;
constexpr double kDanglingClearance = 0.6;

/// Whether a dangling curve from x, at its place next to a segment, keeps away from that: it crosses none.
bool keeps_away(const Vec3& x, const Vec3& end, const Vec3& a, const Vec3& b) {
  const Vec3 u = end - x, w = b - a, from = x - a;
  const double uu = dot(u, u), ww = dot(w, w), uw = dot(u, w), area = uu * ww - uw * uw;
  const auto along = [&](double t) { return nearest_part(a + t * w, x, end); };
  double s = area > 0 ? std::clamp((uw * dot(w, from) - ww * dot(u, from)) / area, 0.0, 1.0) : 0;
  const double t = nearest_part(x + s * u, a, b);
  s = along(t);
  return norm(x + s * u - (a + t * w)) >= kDanglingClearance * s * std::sqrt(uu);
}

}  // namespace

DanglingEdges::DanglingEdges(const Mesh& mesh, const std::vector<int>& points)
    : first_point_(mesh.lines.size()) {
  for (const auto& [a, b] : mesh.lines) segments_.push_back({mesh.points[a], mesh.points[b]});
  for (const int v : points) segments_.push_back({mesh.points[v], mesh.points[v]});
  std::vector<Box<Vec3>> boxes;
  for (const auto& [a, b] : segments_) boxes.push_back(Box<Vec3>::around({a, b}));
  tree_ = BoxTree<Vec3>(boxes);
}

std::optional<std::array<Vec3, 2>> DanglingEdges::ends(std::size_t point, const Vec3& normal, double size,
                                                       const std::function<Vec3(const Vec3&)>& onto) {
  const Vec3 x = segments_[first_point_ + point][0];
  if (distance(point, x) < kShortestDangling * size) return std::nullopt;
  const bool along_x = std::abs(normal.x) > std::abs(normal.y);
  Vec3 u = cross(normal, along_x ? Vec3{0, 1, 0} : Vec3{1, 0, 0});
  u = (1 / norm(u)) * u;
  Vec3 v = cross(normal, u);
  v = (1 / norm(v)) * v;
  for (double length = size; length >= kShortestDangling * size; length *= kDanglingShorter)
    for (int k = 0; k < kDanglingDirections; ++k) {
      const double angle = std::numbers::pi * k / kDanglingDirections;
      const Vec3 along = length * (std::cos(angle) * u + std::sin(angle) * v);
      const std::array<Vec3, 2> ends{onto(x + along), onto(x - along)};
      // Beyond the border of a surface, and around its sharp edges, ends come nearer.
      const double shortest = 0.8 * length;
      if (norm(ends[0] - x) < shortest || norm(ends[1] - x) < shortest || !is_clear(point, ends)) continue;
      taken_.push_back(ends);
      return ends;
    }
  return std::nullopt;
}

bool DanglingEdges::is_clear(std::size_t point, const std::array<Vec3, 2>& ends) const {
  const Vec3 x = segments_[first_point_ + point][0];
  for (const Vec3& end : ends)
    for (int k = 1; k <= kDanglingPlaces; ++k) {
      const Vec3 along = static_cast<double>(k) / kDanglingPlaces * (end - x);
      if (distance(point, x + along) < kDanglingClearance * norm(along)) return false;
    }
  const Box<Vec3> box = Box<Vec3>::around(ends);
  bool is_free = std::ranges::all_of(ends, [&](const Vec3& end) {
    return std::ranges::all_of(taken_, [&](const Segment& s) { return keeps_away(x, end, s[0], s[1]); });
  });
  const double limit = 0;
  tree_.search(
      limit, [&](const auto& node) { return node.box.overlaps(box) ? 0.0 : 1.0; },
      [&](int i) {
        if (static_cast<std::size_t>(i) == first_point_ + point) return;
        for (const Vec3& end : ends)
          is_free = is_free && keeps_away(x, end, segments_[i][0], segments_[i][1]);
      });
  return is_free;
}

double DanglingEdges::distance(std::size_t point, const Vec3& x) const {
  double best = std::numeric_limits<double>::infinity(), best2 = best;
  tree_.nearest(x, best2, [&](int i) {
    if (static_cast<std::size_t>(i) == first_point_ + point) return;
    best = std::min(best, distance_to_segment(x, segments_[i][0], segments_[i][1]));
    best2 = best * best;
  });
  for (const auto& [a, b] : taken_) best = std::min(best, distance_to_segment(x, a, b));
  return best;
}

std::string no_room_for_edges(double size, const std::string& place) {
  return fmt::format(
      "is nearer than a thousandth of the size, {:g}, to a curve or another point at {}: "
      "expected them farther apart, or at the same place [embedded-too-near]",
      size, place);
}

std::vector<std::array<Vec3, 2>> dangling_ends(const Mesh& lines, const std::vector<int>& points,
                                               const SizeField& size,
                                               const std::function<std::string(std::size_t)>& label) {
  DanglingEdges dangling(lines, points);
  std::vector<std::array<Vec3, 2>> all;
  int hint = -1;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3& x = lines.points[points[i]];
    const double length = size.at(x, hint);
    const auto ends = dangling.ends(i, {0, 0, 1}, length, [](const Vec3& end) { return end; });
    if (!ends) throw InputError(label(i) + " " + no_room_for_edges(length, show_point(Vec2{x.x, x.y})));
    all.push_back(*ends);
  }
  return all;
}

}  // namespace delquad
