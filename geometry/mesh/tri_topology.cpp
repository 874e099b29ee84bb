// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/mesh/tri_topology.h"

#include <cassert>
#include <map>
#include <utility>

namespace delquad {

namespace {

void relink(TriPatch& tri, int t, int from, int to) {
  if (t >= 0) tri.neighbours[t][facing_side(tri, t, from)] = to;
}

}  // namespace

int facing_side(const TriPatch& tri, int t, int u) {
  const auto& n = tri.neighbours[t];
  return n[0] == u ? 0 : n[1] == u ? 1 : n[2] == u ? 2 : -1;
}

void link_neighbours(TriPatch& tri) {
  std::map<std::array<int, 2>, std::array<int, 2>> open;
  tri.neighbours.assign(tri.triangles.size(), {-1, -1, -1});
  for (int t = 0; t < static_cast<int>(tri.triangles.size()); ++t)
    for (int k = 0; k < 3; ++k) {
      const int a = tri.triangles[t][(k + 1) % 3], b = tri.triangles[t][(k + 2) % 3];
      if (const auto at = open.find({b, a}); at != open.end()) {
        const auto [u, m] = at->second;
        tri.neighbours[t][k] = u;
        tri.neighbours[u][m] = t;
      } else {
        open[{a, b}] = {t, k};
      }
    }
}

void swap_side(TriPatch& tri, int t, int k) {
  assert(tri.neighbours[t][k] >= 0);
  auto &v = tri.triangles, &n = tri.neighbours;
  const int u = n[t][k], m = facing_side(tri, u, t);
  const int a = v[t][k], b = v[t][(k + 1) % 3], c = v[t][(k + 2) % 3], d = v[u][m];
  const int ab = n[t][(k + 2) % 3], ca = n[t][(k + 1) % 3];
  const int bd = n[u][(m + 1) % 3], dc = n[u][(m + 2) % 3];
  v[t] = {a, b, d}, n[t] = {bd, u, ab};
  v[u] = {a, d, c}, n[u] = {dc, ca, t};
  relink(tri, bd, u, t);
  relink(tri, ca, t, u);
}

void split_side(TriPatch& tri, int t, int k, Vec2 at) {
  assert(tri.neighbours[t][k] >= 0);
  auto &v = tri.triangles, &n = tri.neighbours;
  const int u = n[t][k], m = facing_side(tri, u, t), i = static_cast<int>(tri.points.size());
  const int a = v[t][k], b = v[t][(k + 1) % 3], c = v[t][(k + 2) % 3], d = v[u][m];
  const int ca = n[t][(k + 1) % 3], ab = n[t][(k + 2) % 3];
  const int bd = n[u][(m + 1) % 3], dc = n[u][(m + 2) % 3];
  const int p = static_cast<int>(v.size()), q = p + 1;
  tri.points.push_back(at);
  v[t] = {a, b, i}, n[t] = {u, p, ab};
  v[u] = {i, b, d}, n[u] = {bd, q, t};
  v.insert(v.end(), {{a, i, c}, {i, d, c}});
  n.insert(n.end(), {{q, ca, t}, {dc, p, u}});
  relink(tri, ca, t, p);
  relink(tri, dc, u, q);
}

TriTopology::TriTopology(TriPatch tri) : tri_(std::move(tri)), triangle_of_(tri_.points.size(), -1) {
  for (int t = 0; t < triangle_slots(); ++t) note(t);
}

TriPatch TriTopology::to_patch() const {
  TriPatch tri;
  tri.n_boundary = tri_.n_boundary;
  std::vector<int> point_at(vertex_slots(), -1), triangle_at(triangle_slots(), -1);
  for (int i = 0; i < vertex_slots(); ++i) {
    if (!on_boundary(i) && !vertex_alive(i)) continue;
    point_at[i] = static_cast<int>(tri.points.size());
    tri.points.push_back(point(i));
  }
  for (int t = 0, next = 0; t < triangle_slots(); ++t)
    if (alive(t)) triangle_at[t] = next++;
  for (int t = 0; t < triangle_slots(); ++t) {
    if (!alive(t)) continue;
    tri.triangles.push_back({point_at[vertex(t, 0)], point_at[vertex(t, 1)], point_at[vertex(t, 2)]});
    auto& around = tri.neighbours.emplace_back();
    for (int k = 0; k < 3; ++k) around[k] = across(t, k) < 0 ? -1 : triangle_at[across(t, k)];
  }
  return tri;
}

int TriTopology::corner_at(int t, int i) const { return vertex(t, 0) == i ? 0 : vertex(t, 1) == i ? 1 : 2; }

void TriTopology::note(int t) {
  for (const int i : tri_.triangles[t]) triangle_of_[i] = t;
}

void TriTopology::star(int i, std::vector<TriCorner>& corners) const {
  assert(vertex_alive(i) && !on_boundary(i));
  corners.clear();
  const int first = triangle_of_[i];
  int t = first;
  do {
    const int k = corner_at(t, i);
    corners.push_back({t, k});
    t = across(t, (k + 1) % 3);
  } while (t != first);
}

TriCorner TriTopology::find_inner_edge(int a, int b) const {
  if (!vertex_alive(a) || !vertex_alive(b)) return {-1, 0};
  if (on_boundary(a) && !on_boundary(b)) std::swap(a, b);
  // Walks around a from its known triangle, and both ways if a lies on the boundary.
  const int sides = on_boundary(a) ? 2 : 1;
  for (int way = 1; way <= sides; ++way) {
    int t = triangle_of_[a];
    const int first = t;
    do {
      const int k = corner_at(t, a);
      for (int j = 1; j <= sides; ++j)
        if (vertex(t, k + j) == b) {
          const int opposite = (k + 3 - j) % 3;
          return across(t, opposite) < 0 ? TriCorner{-1, 0} : TriCorner{t, opposite};
        }
      t = across(t, (k + way) % 3);
    } while (t >= 0 && t != first);
  }
  return {-1, 0};
}

bool TriTopology::adjacent(int a, int b) const {
  assert(vertex_alive(a) && vertex_alive(b));
  if (a == b) return false;
  for (const int way : {1, 2}) {
    int t = triangle_of_[a];
    const int first = t;
    do {
      const int k = corner_at(t, a);
      if (vertex(t, k + 1) == b || vertex(t, k + 2) == b) return true;
      t = across(t, (k + way) % 3);
    } while (t >= 0 && t != first);
  }
  return false;
}

void TriTopology::swap(int t, int k) {
  const int u = across(t, k);
  swap_side(tri_, t, k);
  note(t);
  note(u);
}

int TriTopology::split(int t, int k, Vec2 at) {
  const int u = across(t, k), first = triangle_slots();
  split_side(tri_, t, k, at);
  triangle_of_.push_back(-1);
  for (const int changed : {t, u, first, first + 1}) note(changed);
  return vertex_slots() - 1;
}

void TriTopology::collapse(int from, int to, const std::vector<TriCorner>& star) {
  assert(!on_boundary(from) && adjacent(from, to));
  auto &v = tri_.triangles, &n = tri_.neighbours;
  for (const auto& [t, k] : star) {
    const bool gone = vertex(t, k + 1) == to || vertex(t, k + 2) == to;
    if (!gone) {
      v[t][k] = to;
      note(t);
    }
  }
  for (const auto& [t, k] : star) {
    const int j = vertex(t, k + 1) == to ? (k + 1) % 3 : vertex(t, k + 2) == to ? (k + 2) % 3 : -1;
    if (j < 0) continue;
    // The sides opposite of `from` and of `to` become one.
    const int left = n[t][k], right = n[t][j];
    relink(tri_, left, t, right);
    relink(tri_, right, t, left);
    v[t] = {-1, -1, -1};
    for (const int u : {left, right})
      if (u >= 0 && alive(u)) note(u);
  }
  triangle_of_[from] = -1;
}

}  // namespace delquad
