#include "features/embedded/point_whiskers.h"

#include "base/segment.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace delquad {

namespace {

constexpr int kWhiskerDirections = 8;  // of a line
constexpr double kWhiskerShorter = 0.7, kShortestWhisker = 1e-3;
/// Places along a whisker, by their part of its length, keep away from all else by this part of their way.
constexpr int kWhiskerPlaces = 6;
constexpr double kWhiskerRoom = 0.6;

/// Whether a whisker from x, at its place next to a segment, keeps away from that: it crosses none.
bool keeps_away(const Vec3& x, const Vec3& end, const Vec3& a, const Vec3& b) {
  const Vec3 u = end - x, w = b - a, from = x - a;
  const double uu = dot(u, u), ww = dot(w, w), uw = dot(u, w), area = uu * ww - uw * uw;
  const auto along = [&](double t) { return nearest_part(a + t * w, x, end); };
  double s = area > 0 ? std::clamp((uw * dot(w, from) - ww * dot(u, from)) / area, 0.0, 1.0) : 0;
  const double t = nearest_part(x + s * u, a, b);
  s = along(t);
  return norm(x + s * u - (a + t * w)) >= kWhiskerRoom * s * std::sqrt(uu);
}

}  // namespace

PointWhiskers::PointWhiskers(const Mesh& mesh, const std::vector<int>& points) {
  for (const auto& [a, b] : mesh.lines) segments_.push_back({mesh.points[a], mesh.points[b]});
  first_point_ = segments_.size();
  for (const int v : points) segments_.push_back({mesh.points[v], mesh.points[v]});
  std::vector<Box<Vec3>> boxes;
  for (const auto& [a, b] : segments_) boxes.push_back(Box<Vec3>::around({a, b}));
  tree_ = BoxTree<Vec3>(boxes);
}

double PointWhiskers::distance(std::size_t point, const Vec3& x) const {
  double best = std::numeric_limits<double>::infinity(), best2 = best;
  tree_.nearest(x, best2, [&](int i) {
    if (static_cast<std::size_t>(i) == first_point_ + point) return;
    best = std::min(best, distance_to_segment(x, segments_[i][0], segments_[i][1]));
    best2 = best * best;
  });
  for (const auto& [a, b] : taken_) best = std::min(best, distance_to_segment(x, a, b));
  return best;
}

bool PointWhiskers::has_room(std::size_t point, const std::array<Vec3, 2>& ends) const {
  const Vec3 x = segments_[first_point_ + point][0];
  for (const Vec3& end : ends)
    for (int k = 1; k <= kWhiskerPlaces; ++k) {
      const Vec3 along = static_cast<double>(k) / kWhiskerPlaces * (end - x);
      if (distance(point, x + along) < kWhiskerRoom * norm(along)) return false;
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

std::optional<std::array<Vec3, 2>> PointWhiskers::ends(std::size_t point, const Vec3& normal, double size,
                                                       const std::function<Vec3(const Vec3&)>& onto) {
  const Vec3 x = segments_[first_point_ + point][0];
  const bool along_x = std::abs(normal.x) > std::abs(normal.y);
  Vec3 u = cross(normal, along_x ? Vec3{0, 1, 0} : Vec3{1, 0, 0});
  u = (1 / norm(u)) * u;
  Vec3 v = cross(normal, u);
  v = (1 / norm(v)) * v;
  for (double length = size; length >= kShortestWhisker * size; length *= kWhiskerShorter)
    for (int k = 0; k < kWhiskerDirections; ++k) {
      const double angle = std::numbers::pi * k / kWhiskerDirections;
      const Vec3 along = length * (std::cos(angle) * u + std::sin(angle) * v);
      const std::array<Vec3, 2> ends{onto(x + along), onto(x - along)};
      // Beyond the border of a surface, and around its sharp edges, ends come nearer.
      const double shortest = 0.8 * length;
      if (norm(ends[0] - x) < shortest || norm(ends[1] - x) < shortest || !has_room(point, ends)) continue;
      taken_.push_back(ends);
      return ends;
    }
  return std::nullopt;
}

}  // namespace delquad
