// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/mesh/find_crossings.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/box_tree.h"
#include "base/cancel.h"
#include "base/orientation.h"
#include "base/parallel_collect.h"

namespace delquad {
namespace {

using Corners = std::array<Vec3, 3>;

/// Returns the place where an edge of one triangle goes through another.
std::optional<Vec3> edge_through(const Corners& edges, const Corners& triangle) {
  const auto& [a, b, c] = triangle;
  std::array<int, 3> side;
  for (int k = 0; k < 3; ++k) side[k] = orient3d(a, b, c, edges[k]);
  for (int k = 0; k < 3; ++k) {
    const int next = (k + 1) % 3;
    if (side[k] * side[next] >= 0) continue;
    const Vec3 &p = edges[k], &q = edges[next];
    const std::array around = {orient3d(p, q, a, b), orient3d(p, q, b, c), orient3d(p, q, c, a)};
    if (*std::ranges::min_element(around) < 0 && *std::ranges::max_element(around) > 0) continue;
    const Vec3 normal = cross(b - a, c - a);
    const double from = dot(p - a, normal), to = dot(q - a, normal);
    const double t = from == to ? 0.5 : std::clamp(from / (from - to), 0.0, 1.0);
    return p + t * (q - p);
  }
  return std::nullopt;
}

/// Returns whether triangles lie in one plane within `contact`, and overlap there.
bool lie_on_each_other(const Corners& a, const Corners& b, double contact) {
  for (const auto& [own, other] : {std::pair(&a, &b), {&b, &a}}) {
    const Vec3 normal = cross((*own)[1] - (*own)[0], (*own)[2] - (*own)[0]);
    const double length = norm(normal);
    for (const Vec3& p : *other)
      if (!(std::abs(dot(p - (*own)[0], normal)) <= contact * length)) return false;
    for (int k = 0; k < 3; ++k) {
      const Vec3 &from = (*own)[k], out = cross((*own)[(k + 1) % 3] - from, normal);
      const auto is_beyond = [&](const Vec3& p) { return dot(p - from, out) >= -contact * norm(out); };
      if (std::ranges::all_of(*other, is_beyond)) return false;
    }
  }
  return true;
}

/// Returns the crossings; the search in a range of triangles ends after `most`.
std::vector<Crossing> crossings_of(const std::vector<Vec3>& points,
                                   const std::vector<std::array<int, 3>>& triangles,
                                   const MayCross& may_cross, double contact, std::size_t most) {
  const auto corners_of = [&](std::size_t t) {
    return Corners{points[triangles[t][0]], points[triangles[t][1]], points[triangles[t][2]]};
  };
  std::vector<Box<Vec3>> boxes;
  boxes.reserve(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const Corners at = corners_of(t);
    boxes.push_back(Box<Vec3>::around({at[0], at[1], at[2]}));
  }
  const BoxTree<Vec3> tree(boxes);
  return parallel_collect<Crossing>(
      triangles.size(), [&](std::size_t begin, std::size_t end, std::vector<Crossing>& found) {
        for (std::size_t t = begin; t < end && found.size() < most; ++t) {
          check_cancelled();
          const Corners at = corners_of(t);
          const auto far = [&](const auto& node) {
            return node.box.overlaps(boxes[t]) ? 0 : std::numeric_limits<double>::infinity();
          };
          std::vector<Crossing> of_this;
          tree.search(0, far, [&](int other) {
            if (other == static_cast<int>(t) || !boxes[other].overlaps(boxes[t])) return;
            const Corners corners = corners_of(static_cast<std::size_t>(other));
            const auto place = edge_through(at, corners);
            if ((!place && contact == 0) || may_cross(static_cast<int>(t), other)) return;
            if (place)
              of_this.push_back({static_cast<int>(t), other, *place});
            else if (lie_on_each_other(at, corners, contact))
              of_this.push_back({static_cast<int>(t), other, (1.0 / 3) * (at[0] + at[1] + at[2]), true});
          });
          if (of_this.empty()) continue;
          found.push_back(*std::ranges::min_element(of_this, {}, &Crossing::second));
        }
      });
}

}  // namespace

std::vector<Crossing> find_crossings(const std::vector<Vec3>& points,
                                     const std::vector<std::array<int, 3>>& triangles,
                                     const MayCross& may_cross, double contact) {
  return crossings_of(points, triangles, may_cross, contact, triangles.size());
}

std::optional<Crossing> find_crossing(const std::vector<Vec3>& points,
                                      const std::vector<std::array<int, 3>>& triangles,
                                      const MayCross& may_cross) {
  const std::vector<Crossing> crossings = crossings_of(points, triangles, may_cross, 0, 1);
  return crossings.empty() ? std::nullopt : std::optional(crossings.front());
}

}  // namespace delquad
