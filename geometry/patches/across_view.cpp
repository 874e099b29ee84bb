// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/patches/across_view.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "base/cancel.h"
#include "base/segment.h"

namespace delquad {

namespace {

/// Least cosine of the angle between sides that face each other. Sides that are not parallel by kParallel
/// make only a corner if the path between them along the boundary is at most so many widths.
constexpr double kFacing = 0.3, kParallel = 0.97, kCornerPath = 8;
/// Limit of triangles on a look; only needles may be more.
constexpr size_t kMostTriangles = 1000;

Vec2 flat_point(const FlatPatch& map, int v) { return map.flat.points[v]; }

}  // namespace

AcrossView::AcrossView(const Mesh& fine, const std::vector<CurveChain>& chains,
                       const std::vector<FlatPatch>& maps, const std::vector<PatchOutline>& outlines)
    : fine_(fine), maps_(maps), outlines_(outlines) {
  for (const CurveChain& chain : chains) sides_on_.emplace_back(chain.points.size() - 1, std::array{-1, -1});
  for (size_t p = 0; p < maps.size(); ++p) add_patch(static_cast<int>(p));
}

void AcrossView::add_patch(int patch) {
  const FlatPatch& map = maps_[patch];
  std::map<std::pair<int, int>, std::pair<int, int>> owner;  // triangle and its side, by the ends of the side
  for (size_t t = 0; t < map.flat.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      if (map.flat.neighbours[t][k] >= 0) continue;
      const auto& v = map.flat.triangles[t];
      owner[{v[(k + 1) % 3], v[(k + 2) % 3]}] = {static_cast<int>(t), k};
    }
  auto& side_at = side_at_.emplace_back(map.flat.triangles.size(), std::array{-1, -1, -1});
  auto& stretch = stretch_.emplace_back();
  for (size_t t = 0; t < map.flat.triangles.size(); ++t) {
    const auto& v = map.flat.triangles[t];
    const auto plane = [&](int k) { return flat_point(map, v[k]); };
    const double in_space = double_area(map, fine_, t);
    const double in_plane = cross(plane(1) - plane(0), plane(2) - plane(0));
    stretch.push_back(in_space > 0 ? std::sqrt(in_plane / in_space) : 1);
  }
  auto& loop_length = loop_length_.emplace_back();
  for (size_t l = 0; l < outlines_[patch].size(); ++l) {
    double path = 0;
    for (const CurveSide& s : outlines_[patch][l]) {
      const auto [t, k] = owner.at({s.from, s.to});
      const int index = static_cast<int>(sides_.size());
      side_at[t][k] = index;
      auto& on_line = sides_on_[s.chain][s.line];
      on_line[on_line[0] < 0 ? 0 : 1] = index;
      const Vec3 way = fine_.points[map.fine_node[s.to]] - fine_.points[map.fine_node[s.from]];
      const double length = map.sides.empty() ? norm(way) : map.sides[t][k];
      sides_.push_back({&s, patch, static_cast<int>(l), t, k, path, length});
      path += length;
    }
    loop_length.push_back(path);
  }
}

std::vector<Opposite> AcrossView::look(int chain, double s, double reach) const {
  check_cancelled();
  std::vector<Opposite> seen;
  const int n = static_cast<int>(sides_on_[chain].size());
  const int line = std::min(static_cast<int>(s), n - 1);
  for (const int index : sides_on_[chain][line]) {
    if (index < 0) continue;
    const double t = s - line;
    look_from(sides_[index], sides_[index].curve->forward ? t : 1 - t, reach, seen);
  }
  return seen;
}

void AcrossView::look_from(const Side& side, double t, double reach, std::vector<Opposite>& seen) const {
  const FlatPatch& map = maps_[side.patch];
  const Vec2 a = flat_point(map, side.curve->from), b = flat_point(map, side.curve->to),
             start = a + t * (b - a);
  const Vec2 direction = (1 / norm(b - a)) * perp(b - a);
  int triangle = side.triangle, entered = side.k;
  double distance = 0, before = 0;
  for (size_t steps = 0; steps < std::min(kMostTriangles, map.flat.triangles.size()); ++steps) {
    const auto& v = map.flat.triangles[triangle];
    int exit = -1;
    double way = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 3; ++k) {
      const Vec2 p = flat_point(map, v[(k + 1) % 3]), e = flat_point(map, v[(k + 2) % 3]) - p;
      const double leaving = cross(direction, e);
      if (k == entered || !(leaving > 0)) continue;
      const double at = cross(p - start, e) / leaving;
      if (at < way) way = at, exit = k;
    }
    if (exit < 0) return;
    distance += std::max(way - before, 0.0) / stretch_[side.patch][triangle];
    before = std::max(way, before);
    if (distance > reach) return;
    const int next = map.flat.neighbours[triangle][exit];
    if (next < 0) {
      const Side& other = sides_[side_at_[side.patch][triangle][exit]];
      const double along = nearest_part(start + way * direction, flat_point(map, other.curve->from),
                                        flat_point(map, other.curve->to));
      if (faces(side, t, direction, other, along, distance))
        seen.push_back({side.patch, other.curve->chain,
                        other.curve->line + (other.curve->forward ? along : 1 - along), distance});
      return;
    }
    const auto& n = map.flat.neighbours[next];
    entered = static_cast<int>(std::find(n.begin(), n.end(), triangle) - n.begin());
    triangle = next;
  }
}

bool AcrossView::faces(const Side& side, double t, Vec2 direction, const Side& other, double along,
                       double distance) const {
  // The two sides of a cut are the same place.
  if (side.curve->chain == other.curve->chain && side.curve->forward != other.curve->forward) return false;
  const FlatPatch& map = maps_[side.patch];
  const Vec2 e = flat_point(map, other.curve->to) - flat_point(map, other.curve->from);
  const double cosine = cross(direction, e) / norm(e);
  if (!(cosine >= kFacing)) return false;  // NaN if the side has no length
  if (side.loop != other.loop || cosine > kParallel) return true;
  const double path = std::abs(side.path + t * side.length - other.path - along * other.length);
  return std::min(path, loop_length_[side.patch][side.loop] - path) > kCornerPath * distance;
}

}  // namespace delquad
