#include "smoothing/cvt/moving_delaunay.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <utility>

#include "base/cancel.h"
#include "base/predicates.h"
#include "delquad/error.h"
#include "mesh/constrained_delaunay.h"
#include "mesh/tri_topology.h"
#include "smoothing/cvt/blocks.h"

namespace delquad {
namespace {

constexpr std::array<int, 3> kNext = {1, 2, 0}, kLast = {2, 0, 1};
/// How often a way that turns a triangle over is cut in half before the triangulation is made anew.
constexpr int kHalvings = 2;

/// The boundary as the triangulation's own free sides give it.
PatchBoundary boundary_of(const TriPatch& tri) {
  PatchBoundary boundary;
  boundary.points.assign(tri.points.begin(), tri.points.begin() + tri.n_boundary);
  for (std::size_t t = 0; t < tri.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k)
      if (tri.neighbours[t][k] < 0)
        boundary.edges.push_back({tri.triangles[t][kNext[k]], tri.triangles[t][kLast[k]]});
  return boundary;
}

}  // namespace

MovingDelaunay::MovingDelaunay(TriPatch initial) : tri_(std::move(initial)), boundary_(boundary_of(tri_)) {
  for (std::size_t t = 0; t < tri_.triangles.size(); ++t) {
    const auto& v = tri_.triangles[t];
    if (orient2d(tri_.points[v[0]], tri_.points[v[1]], tri_.points[v[2]]) <= 0)
      throw InputError(
          fmt::format("triangle {} of points {}, {}, {} at ({}, {}) is flat or inverted: expected a "
                      "counterclockwise triangulation",
                      t, v[0], v[1], v[2], tri_.points[v[0]].x, tri_.points[v[0]].y));
  }
  find_first_corners();
  make_delaunay();
}

void MovingDelaunay::find_first_corners() {
  first_corner_.assign(tri_.points.size(), -1);
  for (std::size_t t = 0; t < tri_.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const int v = tri_.triangles[t][k];
      if (v >= tri_.n_boundary || tri_.neighbours[t][kLast[k]] < 0)
        first_corner_[v] = 3 * static_cast<int>(t) + k;
    }
}

bool MovingDelaunay::move_to(std::span<const Vec2> inner) {
  std::vector<Vec2> to(tri_.points.begin(), tri_.points.begin() + tri_.n_boundary);
  to.insert(to.end(), inner.begin(), inner.end());
  const std::vector<Vec2> from = tri_.points;
  return follow(from, to, kHalvings) || rebuild(to);
}

bool MovingDelaunay::follow(const std::vector<Vec2>& from, const std::vector<Vec2>& to, int halvings) {
  tri_.points = to;
  if (all_upright()) {
    make_delaunay();
    return true;
  }
  if (halvings > 0) {
    std::vector<Vec2> middle(from.size());
    for (std::size_t i = 0; i < from.size(); ++i) middle[i] = 0.5 * (from[i] + to[i]);
    if (follow(from, middle, halvings - 1) && follow(middle, to, halvings - 1)) return true;
  }
  tri_.points = from;
  return false;
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
  } catch (const InputError&) {  // the points cannot be triangulated, which is what the caller asks
    return false;
  }
  find_first_corners();
  return true;
}

/// Whether the side has a neighbour whose opposite point lies inside of its triangle's circumcircle.
bool MovingDelaunay::illegal(int side) const {
  const int t = side / 3, k = side % 3, u = tri_.neighbours[t][k];
  if (u < 0) return false;
  const auto &v = tri_.triangles[t], &n = tri_.neighbours[u];
  const int j = n[0] == t ? 0 : n[1] == t ? 1 : 2;
  return in_circle_or_unsure(tri_.points[v[0]], tri_.points[v[1]], tri_.points[v[2]],
                             tri_.points[tri_.triangles[u][j]]) > 0;
}

void MovingDelaunay::make_delaunay() {
  const std::size_t n = tri_.triangles.size();
  std::vector<std::vector<int>> found(n_blocks(n));
  parallel_blocks(n, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t)
      for (int k = 0; k < 3; ++k) {
        const int side = 3 * static_cast<int>(t) + k;
        if (static_cast<int>(t) < tri_.neighbours[t][k] && illegal(side))
          found[begin / kBlock].push_back(side);
      }
  });
  stack_.clear();
  for (auto block = found.rbegin(); block != found.rend(); ++block)
    stack_.insert(stack_.end(), block->rbegin(), block->rend());
  while (!stack_.empty()) {
    check_cancelled();
    const int side = stack_.back();
    stack_.pop_back();
    if (illegal(side)) flip(side);
  }
}

/// Turns the diagonal of the two triangles at a side; their outer sides go on the stack.
void MovingDelaunay::flip(int side) {
  ++flips_;
  const int t = side / 3, k = side % 3, u = tri_.neighbours[t][k];
  swap_side(tri_, t, k);
  for (const int changed : {t, u})
    for (int i = 0; i < 3; ++i) {
      const int v = tri_.triangles[changed][i];
      if (v >= tri_.n_boundary || tri_.neighbours[changed][kLast[i]] < 0) first_corner_[v] = 3 * changed + i;
    }
  stack_.insert(stack_.end(), {3 * u + 1, 3 * u, 3 * t + 2, 3 * t});
}

}  // namespace delquad
