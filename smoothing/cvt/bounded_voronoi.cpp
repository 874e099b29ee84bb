// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/cvt/bounded_voronoi.h"

#include <algorithm>
#include <cmath>

#include "smoothing/cvt/blocks.h"

namespace delquad {
namespace {

/// Largest wrong order of two clips on a boundary edge, by rounding, in lengths of the edge.
constexpr double kOrderTolerance = 1e-9;

/// Returns the circumcenter, computed from the first corner to keep digits far from the origin.
Vec2 circumcentre(Vec2 a, Vec2 b, Vec2 c) {
  const Vec2 ab = b - a, ac = c - a;
  const double twice = 2 * cross(ab, ac), bb = dot(ab, ab), cc = dot(ac, ac);
  return a + Vec2{(ac.y * bb - ab.y * cc) / twice, (ab.x * cc - ac.x * bb) / twice};
}

}  // namespace

/// The cells along a boundary edge from its first end.
struct BoundedVoronoi::Chain {
  Vec2 a, b;
  double at = 0;  ///< parameter of the last clip: 0 at a, 1 at b
  int clip = kOutside;
};

bool BoundedVoronoi::build(const MovingDelaunay& delaunay) {
  const TriPatch& tri = delaunay.patch();
  centres_.resize(tri.triangles.size());
  blind_.assign(tri.triangles.size(), -1);
  cut_.assign(tri.points.size(), 0);
  std::fill_n(cut_.begin(), tri.n_boundary, 1);
  clip_of_.clear();
  clips_.clear();
  pieces_.clear();
  parallel_blocks(tri.triangles.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      const auto& v = tri.triangles[t];
      centres_[t] = circumcentre(tri.points[v[0]], tri.points[v[1]], tri.points[v[2]]);
    }
  });
  for (int i = 0; i < tri.n_boundary; ++i) {
    const int t = delaunay.corners(i).front() / 3, k = delaunay.corners(i).front() % 3;
    const auto& v = tri.triangles[t];
    const Vec2 a = tri.points[i], b = tri.points[v[kNextCorner[k]]], apex = tri.points[v[kLastCorner[k]]];
    if (dot(a - apex, b - apex) >= 0) continue;
    Chain chain{a, b};
    if (!grow(tri, t, kLastCorner[k], chain)) return false;
  }
  return true;
}

/// Marks the triangle as blind beyond the chain's boundary edge, and follows the cells along that edge.
bool BoundedVoronoi::grow(const TriPatch& tri, int triangle, int entered, Chain& chain) {
  if (blind_[triangle] >= 0) return false;
  blind_[triangle] = static_cast<int>(clip_of_.size());
  const int index = blind_[triangle];
  clip_of_.push_back({kOutside, kOutside, kOutside});
  const Vec2 along = chain.b - chain.a;
  const auto& v = tri.triangles[triangle];
  for (const int i : v) cut_[i] = 1;
  for (const int k : {kLastCorner[entered], kNextCorner[entered]}) {
    const int beyond = tri.neighbours[triangle][k];
    if (beyond >= 0) {
      const double height = cross(along, centres_[beyond] - chain.a);
      if (!std::isfinite(height)) return false;
      if (height < 0) {
        const auto& n = tri.neighbours[beyond];
        if (!grow(tri, beyond, n[0] == triangle ? 0 : n[1] == triangle ? 1 : 2, chain)) return false;
        continue;
      }
    }
    const int from = v[kNextCorner[k]], to = v[kLastCorner[k]];
    const Vec2 p = tri.points[from], q = tri.points[to];
    const double at = dot(0.5 * (p + q) - chain.a, q - p) / dot(along, q - p);
    if (!(at >= chain.at - kOrderTolerance && at <= 1 + kOrderTolerance)) return false;
    const int clip = static_cast<int>(clips_.size());
    clips_.push_back({3 * triangle + k, from, to, chain.a + at * along, (1 / norm(along)) * along});
    clip_of_[index][k] = clip;
    if (chain.clip != kOutside) pieces_.push_back({to, chain.clip, clip});
    chain.at = at;
    chain.clip = clip;
  }
  return true;
}

}  // namespace delquad
