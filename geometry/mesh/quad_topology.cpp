// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/mesh/quad_topology.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <stdexcept>

namespace delquad {

QuadTopology::QuadTopology(const QuadPatch& mesh, int first_held)
    : n_boundary_(mesh.n_boundary), first_held_(first_held), points_(mesh.points) {
  assert(first_held >= 0 && first_held <= mesh.n_boundary);
  corner_.reserve(4 * (mesh.quads.size() + mesh.triangles.size()));
  for (const auto& q : mesh.quads) corner_.insert(corner_.end(), q.begin(), q.end());
  for (const auto& t : mesh.triangles) corner_.insert(corner_.end(), {t[0], t[1], t[2], -1});
  twin_.assign(corner_.size(), -1);
  out_.assign(points_.size(), -1);
  valence_.assign(points_.size(), 0);
  for (int h = 0; h < static_cast<int>(corner_.size()); ++h) {
    const int v = corner_[h];
    if ((h & 3) == 3 && v == -1 && h >= 4 * static_cast<int>(mesh.quads.size())) continue;
    if (v < 0 || v >= vertex_slots())
      throw std::invalid_argument("quad mesh: element " + std::to_string(h / 4) + " has no vertex " +
                                  std::to_string(v));
    ++valence_[v];
  }
  build_twins();
}

void QuadTopology::build_twins() {
  // Lists half-edges by origin, to find a twin among the few that leave the target.
  std::vector<int> first(points_.size() + 1, 0), leaving(corner_.size());
  for (const int v : corner_)
    if (v >= 0) ++first[v + 1];
  for (std::size_t v = 0; v < points_.size(); ++v) first[v + 1] += first[v];
  std::vector<int> fill(first.begin(), first.end() - 1);
  for (int h = 0; h < static_cast<int>(corner_.size()); ++h)
    if (corner_[h] >= 0) leaving[fill[corner_[h]]++] = h;

  for (int h = 0; h < static_cast<int>(corner_.size()); ++h) {
    if (corner_[h] < 0) continue;
    const int a = corner_[h], b = target(h);
    for (int i = first[a]; i < first[a + 1]; ++i)
      if (leaving[i] != h && target(leaving[i]) == b)
        throw std::invalid_argument("quad mesh: two elements run from vertex " + std::to_string(a) + " to " +
                                    std::to_string(b));
    for (int i = first[b]; i < first[b + 1]; ++i)
      if (target(leaving[i]) == a) twin_[h] = leaving[i];
    if (twin_[h] < 0 && (!on_boundary(a) || !on_boundary(b)))
      throw std::invalid_argument("quad mesh: the edge from vertex " + std::to_string(a) + " to " +
                                  std::to_string(b) + " is open though not both ends are boundary points");
    if (twin_[h] < 0 || out_[a] < 0) out_[a] = h;
  }
}

QuadPatch QuadTopology::to_patch() const {
  QuadPatch mesh;
  mesh.n_boundary = n_boundary_;
  std::vector<int> number(points_.size(), -1);
  for (int v = 0; v < vertex_slots(); ++v) {
    if (!vertex_alive(v) && !on_boundary(v)) continue;
    number[v] = static_cast<int>(mesh.points.size());
    mesh.points.push_back(points_[v]);
  }
  for (int e = 0; e < element_slots(); ++e) {
    if (!alive(e)) continue;
    const int* c = &corner_[4 * e];
    if (is_quad(e))
      mesh.quads.push_back({number[c[0]], number[c[1]], number[c[2]], number[c[3]]});
    else
      mesh.triangles.push_back({number[c[0]], number[c[1]], number[c[2]]});
  }
  return mesh;
}

bool QuadTopology::adjacent(int a, int b) const {
  bool found = false;
  for_each_out(a, [&](int h) { found |= target(h) == b || origin(prev(h)) == b; });
  return found;
}

std::array<int, 6> QuadTopology::hexagon(int h) const {
  assert(twin_[h] >= 0 && is_quad(element(h)) && is_quad(element(twin_[h])));
  const int t = twin_[h];
  const int bc = next(h), cd = next(bc), ae = next(t), ef = next(ae);
  return {corner_[bc], corner_[cd], target(cd), corner_[ae], corner_[ef], target(ef)};
}

bool QuadTopology::can_open(int h) const {
  if (twin_[h] < 0 || !is_quad(element(h)) || !is_quad(element(twin_[h]))) return false;
  const auto x = hexagon(h);
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < i; ++j)
      if (x[i] == x[j]) return false;
  return true;
}

bool QuadTopology::can_rotate(int h, bool counterclockwise) const {
  if (!can_open(h)) return false;
  const auto x = hexagon(h);
  return counterclockwise ? !adjacent(x[1], x[4]) : !adjacent(x[2], x[5]);
}

void QuadTopology::open(int h, bool counterclockwise) {
  assert(can_open(h));
  // Indices are places in the hexagon; 6 and 7 are the new vertices, next to 1 and 4 or to 2 and 5.
  using Quads = std::array<std::array<int, 4>, 4>;
  constexpr Quads kCounterclockwise{{{0, 1, 6, 7}, {1, 2, 3, 6}, {3, 4, 7, 6}, {4, 5, 0, 7}}};
  constexpr Quads kClockwise{{{2, 3, 7, 6}, {3, 4, 5, 7}, {5, 0, 6, 7}, {2, 6, 0, 1}}};
  const Quads& quads = counterclockwise ? kCounterclockwise : kClockwise;
  const int other = twin_[h], p = counterclockwise ? 1 : 2, q = p + 3;
  std::array<int, 8> x;
  std::ranges::copy(hexagon(h), x.begin());
  std::array<int, 6> outside;
  for (int k = 0, g = next(h), f = next(other); k < 3; ++k, g = next(g), f = next(f))
    outside[k] = twin_[g], outside[k + 3] = twin_[f];
  // Each new vertex is in the middle of its three neighbors.
  const Vec2 at_p = points_[x[p]] + points_[x[counterclockwise ? 3 : 0]];
  const Vec2 at_q = points_[x[q]] + points_[x[counterclockwise ? 0 : 3]];
  x[6] = add_vertex(0.125 * (3 * at_p + at_q));
  x[7] = add_vertex(0.125 * (at_p + 3 * at_q));
  for (const int v : {x[p], x[q]}) add_to_valence(v, 1);
  for (const int v : {x[6], x[7]}) write(kValence, v, 3);

  const std::array<int, 4> element_of{element(h), element(other), add_element(), add_element()};
  const auto twin_of = [&](int from, int to) {
    if (from < 6 && to == (from + 1) % 6) return outside[from];
    for (int i = 0; i < 4; ++i)
      for (int k = 0; k < 4; ++k)
        if (quads[i][k] == to && quads[i][(k + 1) % 4] == from) return 4 * element_of[i] + k;
    return -1;
  };
  for (int i = 0; i < 4; ++i) {
    std::array<int, 4> corners, twins;
    for (int k = 0; k < 4; ++k) {
      corners[k] = x[quads[i][k]];
      twins[k] = twin_of(quads[i][k], quads[i][(k + 1) % 4]);
    }
    set_element(element_of[i], corners, twins);
  }
}

int QuadTopology::rotate(int h, bool counterclockwise) {
  assert(can_rotate(h, counterclockwise));
  const int a_side = element(h), b_side = element(twin_[h]);
  const auto [b, c, d, a, e, f] = hexagon(h);
  const int bc = next(h), cd = next(bc), da = next(cd);
  const int ae = next(twin_[h]), ef = next(ae), fb = next(ef);
  const int t_bc = twin_[bc], t_cd = twin_[cd], t_da = twin_[da];
  const int t_ae = twin_[ae], t_ef = twin_[ef], t_fb = twin_[fb];
  add_to_valence(a, -1);
  add_to_valence(b, -1);
  if (counterclockwise) {
    add_to_valence(c, 1);
    add_to_valence(e, 1);
    set_element(a_side, {e, c, d, a}, {4 * b_side, t_cd, t_da, t_ae});
    set_element(b_side, {c, e, f, b}, {4 * a_side, t_ef, t_fb, t_bc});
  } else {
    add_to_valence(d, 1);
    add_to_valence(f, 1);
    set_element(a_side, {d, f, b, c}, {4 * b_side, t_fb, t_bc, t_cd});
    set_element(b_side, {f, d, a, e}, {4 * a_side, t_da, t_ae, t_ef});
  }
  return 4 * a_side;
}

bool QuadTopology::can_collapse(int h) const {
  if (!is_quad(element(h))) return false;
  const int a = origin(h), b = target(h), c = target(next(h)), d = origin(prev(h));
  if (on_boundary(c)) return false;
  if ((!on_boundary(b) && valence_[b] < 3) || (!on_boundary(d) && valence_[d] < 3)) return false;
  // Any other common neighbor, or an edge between the two, would become a double edge or a loop.
  bool free = true;
  for_each_out(c, [&](int g) {
    const int n = target(g);
    if (n == a || (n != b && n != d && adjacent(a, n))) free = false;
  });
  return free;
}

void QuadTopology::collapse(int h) {
  assert(can_collapse(h));
  const int ab = h, bc = next(ab), cd = next(bc), da = next(cd);
  const int a = corner_[ab], b = corner_[bc], c = corner_[cd], d = corner_[da];
  const int t_ab = twin_[ab], t_bc = twin_[bc], t_cd = twin_[cd], t_da = twin_[da];
  write(kValence, a, valence_[a] + valence_[c] - 2);
  add_to_valence(b, -1);
  add_to_valence(d, -1);
  for (int g = out_[c], first = g; g >= 0;) {
    const int following = around(g);
    write(kCorner, g, a);
    g = following == first ? -1 : following;
  }
  // c is interior, so its own sides have twins; what lies across a's sides may be the outside.
  link(t_bc, t_ab);
  link(t_cd, t_da);
  if (!on_boundary(a) || t_ab < 0) write(kOut, a, t_bc);
  if (!on_boundary(b)) write(kOut, b, t_ab);
  if (!on_boundary(d) || t_da < 0) write(kOut, d, t_cd);
  write(kOut, c, -1);
  write(kValence, c, 0);
  kill_element(element(h));
}

bool QuadTopology::can_split(int from, int to) const {
  if (from == to || corner_[from] != corner_[to] || corner_[from] < 0) return false;
  if (twin_[from] < 0 || twin_[to] < 0) return false;
  int moving = 0;
  for (int h = from; h != to; h = around(h), ++moving)
    if (around(h) < 0) return false;
  const int v = corner_[from];
  return moving >= 2 && valence_[v] - moving >= (on_boundary(v) ? 1 : 2);
}

void QuadTopology::split(int from, int to) {
  assert(can_split(from, to));
  const int v = corner_[from], a = target(from), b = target(to), t_from = twin_[from], t_to = twin_[to];
  const int opened = add_vertex(points_[v]), quad = add_element();
  int moving = 0;
  for (int h = from; h != to; h = around(h), ++moving) write(kCorner, h, opened);
  write(kOut, opened, from);
  write(kValence, opened, moving + 1);
  add_to_valence(v, 1 - moving);
  add_to_valence(a, 1);
  add_to_valence(b, 1);
  set_element(quad, {v, a, opened, b}, {t_from, from, t_to, to});
}

bool QuadTopology::can_remove_doublet(int v) const {
  if (on_boundary(v) || valence_[v] != 2) return false;
  const int h = out_[v], g = around(h);
  const int e = element(h), f = element(g);
  if (!is_quad(e) && !is_quad(f)) return false;
  // The far corners must differ, else the quad would have no area.
  return !is_quad(e) || !is_quad(f) || target(next(h)) != target(next(g));
}

void QuadTopology::remove_doublet(int v) {
  assert(can_remove_doublet(v));
  const std::array<int, 2> start{out_[v], around(out_[v])};
  std::array<int, 4> corners{-1, -1, -1, -1}, twins{-1, -1, -1, -1};
  int n = 0;
  for (const int h : start) {
    add_to_valence(target(h), -1);
    for (int g = next(h); target(g) != v; g = next(g), ++n) corners[n] = corner_[g], twins[n] = twin_[g];
  }
  write(kOut, v, -1);
  write(kValence, v, 0);
  kill_element(element(start[1]));
  set_element(element(start[0]), corners, twins);
}

/// Returns the half-edges of the quads whose twins belong to other elements or none.
std::vector<int> QuadTopology::outline(std::span<const int> quads) const {
  std::vector<int> sides;
  for (const int e : quads)
    for (int h = 4 * e; h < 4 * e + 4; ++h)
      if (twin_[h] < 0 || std::find(quads.begin(), quads.end(), element(twin_[h])) == quads.end())
        sides.push_back(h);
  return sides;
}

bool QuadTopology::can_pillow(std::span<const int> quads) const {
  if (!std::all_of(quads.begin(), quads.end(), [&](int e) { return is_quad(e); })) return false;
  std::vector<int> origins;
  for (const int h : outline(quads)) origins.push_back(origin(h));
  std::sort(origins.begin(), origins.end());
  return std::adjacent_find(origins.begin(), origins.end()) == origins.end();
}

void QuadTopology::pillow(std::span<const int> quads) {
  assert(can_pillow(quads));
  const std::vector<int> sides = outline(quads);
  const int n = static_cast<int>(sides.size()), first_vertex = vertex_slots(), first_quad = element_slots();
  std::vector<int> corner, across;
  for (const int h : sides) corner.push_back(origin(h)), across.push_back(twin_[h]);
  const auto place_of = [&](int v) {
    return static_cast<int>(std::find(corner.begin(), corner.end(), v) - corner.begin());
  };
  std::vector<int> following, before(n);  // places along the outline
  for (const int h : sides) following.push_back(place_of(target(h)));
  for (int i = 0; i < n; ++i) before[following[i]] = i;

  std::vector<Vec2> middle(n);
  std::vector<int> inside(n, 0);  // quads at each corner
  for (const int e : quads) {
    Vec2 centre;
    for (int k = 0; k < 4; ++k) centre += 0.25 * points_[corner_[4 * e + k]];
    for (int k = 0; k < 4; ++k)
      if (const int i = place_of(corner_[4 * e + k]); i < n) middle[i] += centre, ++inside[i];
  }
  for (int i = 0; i < n; ++i) {
    add_vertex(0.5 * (points_[corner[i]] + (1.0 / inside[i]) * middle[i]));
    add_element();
    write(kValence, first_vertex + i, inside[i] + 2);
    add_to_valence(corner[i], 2 - inside[i]);
  }
  for (const int e : quads)
    for (int h = 4 * e; h < 4 * e + 4; ++h)
      if (const int i = place_of(corner_[h]); i < n) write(kCorner, h, first_vertex + i);
  for (int i = 0; i < n; ++i) {
    const int l = following[i];
    set_element(first_quad + i, {corner[i], corner[l], first_vertex + l, first_vertex + i},
                {across[i], 4 * (first_quad + l) + 3, sides[i], 4 * (first_quad + before[i]) + 1});
  }
}

/// Returns whether one of these vertices has two edges to one vertex.
bool QuadTopology::has_double_edge(std::span<const int> vertices) const {
  std::vector<int> ends;
  return std::ranges::any_of(vertices, [&](int v) {
    ends.clear();
    int last = -1;
    for_each_out(v, [&](int h) { ends.push_back(target(h)), last = h; });
    if (around(last) < 0) ends.push_back(origin(prev(last)));
    std::ranges::sort(ends);
    return std::ranges::adjacent_find(ends) != ends.end();
  });
}

bool QuadTopology::refill(std::span<const int> quads, std::span<const int> rim, std::span<const Vec2> inside,
                          std::span<const std::array<int, 4>> fill) {
  assert(std::ranges::all_of(quads, [&](int e) { return is_quad(e); }));
  assert(std::ranges::is_permutation(rim, outline(quads)));
  const Mark start = mark();
  const int n_rim = static_cast<int>(rim.size());
  std::vector<int> vertex, across;
  for (const int h : rim) vertex.push_back(origin(h)), across.push_back(twin_[h]);
  const std::vector<int> on_rim = vertex;
  for (const Vec2 at : inside) vertex.push_back(add_vertex(at));
  for (const int e : quads)
    for (int k = 0; k < 4; ++k) {
      const int v = corner_[4 * e + k];
      add_to_valence(v, -1);
      if (valence_[v] == 0) write(kOut, v, -1);
    }
  for (const int e : quads) kill_element(e);

  struct Side {
    int from, to, half_edge;
    auto operator<=>(const Side&) const = default;
  };
  std::vector<Side> sides;
  const int first = element_slots();
  for (std::size_t q = 0; q < fill.size(); ++q) {
    const int e = add_element();
    for (int k = 0; k < 4; ++k) sides.push_back({fill[q][k], fill[q][(k + 1) % 4], 4 * e + k});
  }
  std::ranges::sort(sides);
  for (std::size_t q = 0; q < fill.size(); ++q) {
    std::array<int, 4> corners, twins;
    for (int k = 0; k < 4; ++k) {
      const int a = fill[q][k], b = fill[q][(k + 1) % 4];
      corners[k] = vertex[a];
      add_to_valence(corners[k], 1);
      if (a < n_rim && b == (a + 1) % n_rim)
        twins[k] = across[a];
      else
        twins[k] = std::ranges::lower_bound(sides, Side{b, a, 0})->half_edge;
    }
    set_element(first + static_cast<int>(q), corners, twins);
  }
  if (!has_double_edge(on_rim)) return true;
  rollback(start);
  return false;
}

void QuadTopology::move(int v, Vec2 to) {
  assert(v >= 0 && v < vertex_slots() && std::isfinite(to.x) && std::isfinite(to.y));
  move_log_.push_back({v, points_[v]});
  points_[v] = to;
}

void QuadTopology::rollback(const Mark& mark) {
  assert(mark.ints <= int_log_.size() && mark.moves <= move_log_.size());
  assert(mark.vertices <= points_.size() && 4 * mark.elements <= corner_.size());
  for (; int_log_.size() > mark.ints; int_log_.pop_back())
    (this->*int_log_.back().array)[int_log_.back().index] = int_log_.back().old;
  for (; move_log_.size() > mark.moves; move_log_.pop_back())
    points_[move_log_.back().vertex] = move_log_.back().old;
  points_.resize(mark.vertices);
  out_.resize(mark.vertices);
  valence_.resize(mark.vertices);
  corner_.resize(4 * mark.elements);
  twin_.resize(4 * mark.elements);
}

void QuadTopology::write(Array which, int index, int value) {
  int& slot = (this->*which)[index];
  if (slot == value) return;
  int_log_.push_back({which, index, slot});
  slot = value;
}

void QuadTopology::link(int h, int twin) {
  write(kTwin, h, twin);
  if (twin >= 0) write(kTwin, twin, h);
}

void QuadTopology::set_element(int element, std::array<int, 4> corners, std::array<int, 4> twins) {
  for (int k = 0; k < 4; ++k) {
    const int h = 4 * element + k, v = corners[k];
    write(kCorner, h, v);
    link(h, v < 0 ? -1 : twins[k]);
    if (v >= 0 && (!on_boundary(v) || twins[k] < 0)) write(kOut, v, h);
  }
}

void QuadTopology::kill_element(int element) {
  for (int k = 0; k < 4; ++k) write(kCorner, 4 * element + k, -1);
}

int QuadTopology::add_element() {
  corner_.insert(corner_.end(), 4, -1);
  twin_.insert(twin_.end(), 4, -1);
  return element_slots() - 1;
}

int QuadTopology::add_vertex(Vec2 at) {
  points_.push_back(at);
  out_.push_back(-1);
  valence_.push_back(0);
  return vertex_slots() - 1;
}

}  // namespace delquad
