// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/mesh/delaunay_kernel.h"

#include "base/predicates.h"

namespace delquad {

namespace {

constexpr std::array<int, 5> kNext = {1, 2, 0, 1, 2};  // kNext[k] = k + 1 mod 3, kNext[k + 1] = k + 2 mod 3

}  // namespace

DelaunayKernel::DelaunayKernel(const TriPatch& initial) : points_(initial.points) {
  triangles_.reserve(initial.triangles.size());
  for (size_t t = 0; t < initial.triangles.size(); ++t) {
    triangles_.push_back({initial.triangles[t], initial.neighbours[t]});
  }
}

int DelaunayKernel::side_of(int triangle, int neighbour) const {
  const auto& n = triangles_[triangle].n;
  return n[0] == neighbour ? 0 : n[1] == neighbour ? 1 : 2;
}

int DelaunayKernel::locate(Vec2 x, int start) const {
  int t = start, entered = -1;
  // A walk over a constrained triangulation may run in a circle, so its steps are limited by the number of
  // triangles.
  for (size_t steps = 0; steps <= triangles_.size(); ++steps) {
    const Triangle& tri = triangles_[t];
    int leave = -1;
    for (int k = 0; k < 3; ++k) {
      if (tri.n[k] >= 0 && tri.n[k] == entered) continue;
      if (orient2d(points_[tri.v[kNext[k]]], points_[tri.v[kNext[k + 1]]], x) < 0) {
        leave = k;
        break;
      }
    }
    if (leave < 0) return t;
    if (tri.n[leave] < 0) return -1;
    entered = t;
    t = tri.n[leave];
  }
  return -1;
}

bool DelaunayKernel::find_cavity(Vec2 x, int triangle) {
  cavity_.assign(1, triangle);
  shell_.clear();
  stack_.assign({{triangle, 2}, {triangle, 1}, {triangle, 0}});
  // Sides are examined in counterclockwise order, so that the shell comes out as a closed polygon.
  while (!stack_.empty()) {
    const auto [t, k] = stack_.back();
    stack_.pop_back();
    const Triangle& tri = triangles_[t];
    const int beyond = tri.n[k];
    if (beyond >= 0) {
      const auto& v = triangles_[beyond].v;
      if (in_circle(points_[v[0]], points_[v[1]], points_[v[2]], x) > 0) {
        const int back = side_of(beyond, t);
        cavity_.push_back(beyond);
        stack_.push_back({beyond, kNext[back + 1]});
        stack_.push_back({beyond, kNext[back]});
        continue;
      }
    }
    const int a = tri.v[kNext[k]], b = tri.v[kNext[k + 1]];
    // A constrained Delaunay cavity is star-shaped about any point inside its seed triangle. The remaining
    // case is a point on the seed's own outline that is also on the shell: on the boundary or on a vertex.
    if (t == triangle && orient2d(points_[a], points_[b], x) <= 0) return false;
    shell_.push_back({a, b, beyond, t, k});
  }
  return true;
}

std::span<const int> DelaunayKernel::insert(Vec2 x) {
  const int vertex = static_cast<int>(points_.size());
  points_.push_back(x);
  star_ = cavity_;
  while (star_.size() < shell_.size()) {
    star_.push_back(static_cast<int>(triangles_.size()));
    triangles_.emplace_back();
  }
  const size_t m = shell_.size();
  // Outer neighbors first find their way back by the old indices, then the star overwrites the cavity.
  for (size_t k = 0; k < m; ++k) {
    const ShellEdge& e = shell_[k];
    if (e.outer < 0) continue;
    Triangle& outer = triangles_[e.outer];
    for (int j = 0; j < 3; ++j) {
      if (outer.n[j] == e.inner && outer.v[kNext[j]] == e.b) {
        outer.n[j] = -2 - star_[k];  // marked, so that a neighbor over two shell edges is not matched twice
        break;
      }
    }
  }
  for (size_t k = 0; k < m; ++k) {
    const ShellEdge& e = shell_[k];
    triangles_[star_[k]] = {{vertex, e.a, e.b},
                            {e.outer, star_[k + 1 < m ? k + 1 : 0], star_[k > 0 ? k - 1 : m - 1]}};
    if (e.outer < 0) continue;
    for (int& n : triangles_[e.outer].n) {
      if (n == -2 - star_[k]) n = star_[k];
    }
  }
  return star_;
}

TriPatch DelaunayKernel::to_patch(int n_boundary) const {
  TriPatch patch;
  patch.points = points_;
  patch.n_boundary = n_boundary;
  patch.triangles.reserve(triangles_.size());
  patch.neighbours.reserve(triangles_.size());
  for (const Triangle& t : triangles_) {
    patch.triangles.push_back(t.v);
    patch.neighbours.push_back(t.n);
  }
  return patch;
}

}  // namespace delquad
