// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/cvt/moving_delaunay.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Spatial_sort_traits_adapter_2.h>
#include <CGAL/hilbert_sort.h>
#include <CGAL/property_map.h>

#include <algorithm>
#include <atomic>
#include <numeric>
#include <utility>

#include "base/cancel.h"
#include "base/located.h"
#include "base/predicates.h"
#include "delquad/error.h"
#include "geometry/mesh/constrained_delaunay.h"
#include "geometry/mesh/tri_topology.h"
#include "smoothing/cvt/blocks.h"

namespace delquad {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

std::vector<std::size_t> hilbert_order(const std::vector<Vec2>& points) {
  using Map = CGAL::Pointer_property_map<Kernel::Point_2>::const_type;
  std::vector<Kernel::Point_2> at;
  at.reserve(points.size());
  for (const Vec2 x : points) at.emplace_back(x.x, x.y);
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const CGAL::Spatial_sort_traits_adapter_2<Kernel, Map> traits(CGAL::make_property_map(std::as_const(at)));
  CGAL::hilbert_sort(order.begin(), order.end(), traits);
  return order;
}

}  // namespace

std::vector<int> spatial_order(const TriPatch& patch) {
  std::vector<int> order;
  for (const std::size_t i : hilbert_order(patch.points))
    if (static_cast<int>(i) >= patch.n_boundary) order.push_back(static_cast<int>(i));
  return order;
}

TriPatch reordered(const TriPatch& patch, const std::vector<int>& order) {
  TriPatch result;
  result.n_boundary = patch.n_boundary;
  result.points = patch.points;
  std::vector<int> place(patch.points.size());
  std::iota(place.begin(), place.end(), 0);
  for (std::size_t k = 0; k < order.size(); ++k) {
    place[order[k]] = patch.n_boundary + static_cast<int>(k);
    result.points[patch.n_boundary + k] = patch.points[order[k]];
  }
  // The last corner is an inner point if there is one.
  const auto key = [&](int t) {
    const auto& v = patch.triangles[t];
    return std::max({place[v[0]], place[v[1]], place[v[2]]});
  };
  std::vector<int> triangles(patch.triangles.size()), triangle_place(patch.triangles.size());
  std::iota(triangles.begin(), triangles.end(), 0);
  std::ranges::stable_sort(triangles, {}, key);
  for (std::size_t k = 0; k < triangles.size(); ++k) triangle_place[triangles[k]] = static_cast<int>(k);
  for (const int t : triangles) {
    auto& v = result.triangles.emplace_back(patch.triangles[t]);
    auto& n = result.neighbours.emplace_back(patch.neighbours[t]);
    for (int k = 0; k < 3; ++k) {
      v[k] = place[v[k]];
      if (n[k] >= 0) n[k] = triangle_place[n[k]];
    }
  }
  return result;
}

namespace {

/// Halvings of a move that inverts a triangle, before the triangulation is rebuilt.
constexpr int kHalvings = 2;
/// Spare corners of a point.
constexpr unsigned kSpare = 2;

/// Returns the boundary by the free sides of the triangulation.
PatchBoundary boundary_of(const TriPatch& tri) {
  PatchBoundary boundary;
  boundary.points.assign(tri.points.begin(), tri.points.begin() + tri.n_boundary);
  for (std::size_t t = 0; t < tri.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k)
      if (tri.neighbours[t][k] < 0)
        boundary.edges.push_back({tri.triangles[t][kNextCorner[k]], tri.triangles[t][kLastCorner[k]]});
  return boundary;
}

}  // namespace

MovingDelaunay::MovingDelaunay(TriPatch initial) : tri_(std::move(initial)), boundary_(boundary_of(tri_)) {
  for (std::size_t t = 0; t < tri_.triangles.size(); ++t) {
    const auto& v = tri_.triangles[t];
    if (orient2d(tri_.points[v[0]], tri_.points[v[1]], tri_.points[v[2]]) <= 0)
      refuse(
          "triangle {} of points {}, {}, {} at ({}, {}) is flat or inverted: expected a "
          "counterclockwise triangulation",
          t, v[0], v[1], v[2], tri_.points[v[0]].x, tri_.points[v[0]].y);
  }
  make_stars();
  make_delaunay();
}

void MovingDelaunay::make_stars() {
  star_.assign(tri_.points.size(), {});
  for (std::size_t t = 0; t < tri_.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      Star& star = star_[tri_.triangles[t][k]];
      ++star.room;
      if (star.first < 0 || tri_.neighbours[t][kLastCorner[k]] < 0) star.first = 3 * static_cast<int>(t) + k;
    }
  std::size_t n = 0;
  for (Star& star : star_) {
    star.begin = n;
    n += star.room += kSpare;
  }
  stars_.resize(n);
  parallel_blocks(star_.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) renew_star(static_cast<int>(i));
  });
}

/// Lists the corners around a point. Returns false if they need more space.
bool MovingDelaunay::renew_star(int i) {
  Star& star = star_[i];
  star.count = 0;
  star.stale = false;
  int t = star.first / 3;
  do {
    if (star.count == star.room) return false;
    const auto& v = tri_.triangles[t];
    const int k = v[0] == i ? 0 : v[1] == i ? 1 : 2;
    stars_[star.begin + star.count++] = 3 * t + k;
    t = tri_.neighbours[t][kNextCorner[k]];
  } while (t >= 0 && t != star.first / 3);
  return true;
}

bool MovingDelaunay::move_to(std::span<const Vec2> inner) {
  to_.resize(tri_.points.size());
  const std::size_t n_boundary = static_cast<std::size_t>(tri_.n_boundary);
  parallel_blocks(to_.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      to_[i] = i < n_boundary ? tri_.points[i] : inner[i - n_boundary];
  });
  std::swap(tri_.points, to_);
  if (all_upright()) {
    make_delaunay();
    return true;
  }
  const std::vector<Vec2> to = tri_.points, from = to_;
  return follow_in_halves(from, to, kHalvings) || rebuild(to);
}

bool MovingDelaunay::follow_in_halves(const std::vector<Vec2>& from, const std::vector<Vec2>& to,
                                      int halvings) {
  if (halvings > 0) {
    std::vector<Vec2> middle(from.size());
    for (std::size_t i = 0; i < from.size(); ++i) middle[i] = 0.5 * (from[i] + to[i]);
    if (follow(from, middle, halvings - 1) && follow(middle, to, halvings - 1)) return true;
  }
  tri_.points = from;
  return false;
}

bool MovingDelaunay::follow(const std::vector<Vec2>& from, const std::vector<Vec2>& to, int halvings) {
  tri_.points = to;
  if (all_upright()) {
    make_delaunay();
    return true;
  }
  return follow_in_halves(from, to, halvings);
}

bool MovingDelaunay::all_upright() const {
  std::atomic<bool> upright = true;
  parallel_blocks(tri_.triangles.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end && upright.load(std::memory_order_relaxed); ++t) {
      const auto& v = tri_.triangles[t];
      if (orient2d(tri_.points[v[0]], tri_.points[v[1]], tri_.points[v[2]]) <= 0) upright = false;
    }
  });
  return upright;
}

bool MovingDelaunay::rebuild(const std::vector<Vec2>& points) {
  ++rebuilds_;
  try {
    tri_ = constrained_delaunay(boundary_, {points.begin() + tri_.n_boundary, points.end()});
  } catch (const InputError&) {  // a point set without triangulation is a valid answer
    return false;
  }
  make_stars();
  return true;
}

/// Returns whether the opposite point across this inner side lies inside the circumcircle of its triangle.
bool MovingDelaunay::illegal(int side) const {
  const int t = side / 3, k = side % 3;
  const auto &v = tri_.triangles[t], &n = tri_.triangles[tri_.neighbours[t][k]];
  const int apex = n[0] ^ n[1] ^ n[2] ^ v[kNextCorner[k]] ^ v[kLastCorner[k]];  // the corner off the side
  return in_circle_filtered(tri_.points[v[0]], tri_.points[v[1]], tri_.points[v[2]], tri_.points[apex]) > 0;
}

/// Appends the illegal sides of triangles begin .. end - 1, each by its triangle of smaller index.
void MovingDelaunay::find_illegal(std::size_t begin, std::size_t end, std::vector<int>& found) const {
  std::array<int, 3 * kBlock> sides;  // all sides first, then the tests: no branch is hard to predict
  std::size_t n = 0;
  for (std::size_t t = begin; t < end; ++t)
    for (int k = 0; k < 3; ++k) {
      sides[n] = 3 * static_cast<int>(t) + k;
      n += static_cast<std::size_t>(static_cast<int>(t) < tri_.neighbours[t][k]);
    }
  for (std::size_t i = 0; i < n; ++i)
    if (illegal(sides[i])) found.push_back(sides[i]);
}

void MovingDelaunay::make_delaunay() {
  const std::size_t n = tri_.triangles.size();
  std::vector<std::vector<int>> found(n_blocks(n));
  parallel_blocks(
      n, [&](std::size_t begin, std::size_t end) { find_illegal(begin, end, found[begin / kBlock]); });
  stack_.clear();
  for (auto block = found.rbegin(); block != found.rend(); ++block)
    stack_.insert(stack_.end(), block->rbegin(), block->rend());
  while (!stack_.empty()) {
    check_cancelled();
    const int side = stack_.back();
    stack_.pop_back();
    if (tri_.neighbours[side / 3][side % 3] >= 0 && illegal(side)) flip(side);
  }
  const bool all_have_room = std::ranges::all_of(stale_, [&](int i) { return renew_star(i); });
  stale_.clear();
  if (!all_have_room) make_stars();
}

/// Swaps the diagonal of the two triangles at a side, and stacks their outer sides.
void MovingDelaunay::flip(int side) {
  ++flips_;
  const int t = side / 3, k = side % 3, u = tri_.neighbours[t][k];
  swap_side(tri_, t, k);
  for (const int changed : {t, u})
    for (int i = 0; i < 3; ++i) {
      const int v = tri_.triangles[changed][i];
      Star& star = star_[v];
      if (v >= tri_.n_boundary || tri_.neighbours[changed][kLastCorner[i]] < 0) star.first = 3 * changed + i;
      if (!star.stale) stale_.push_back(v);
      star.stale = true;
    }
  stack_.insert(stack_.end(), {3 * u + 1, 3 * u, 3 * t + 2, 3 * t});
}

}  // namespace delquad
