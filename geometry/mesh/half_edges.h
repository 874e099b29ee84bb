// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "delquad/mesh.h"

// This header has the sides of elements, sorted by their nodes. Most modules use it.

namespace delquad {

/// One side of a triangle or quad.
struct HalfEdge {
  int lo, hi;    ///< its ends, lo <= hi
  int element;   ///< triangles first, then quads
  bool forward;  ///< the element runs from lo to hi

  /// Returns its ends, as the element runs.
  std::array<int, 2> run() const { return forward ? std::array{lo, hi} : std::array{hi, lo}; }
};

/// Calls visit(element, vertices) for every triangle, then every quad; `vertices` is an array of 3 or 4.
template <class Visit>
void for_each_element(const Mesh& mesh, Visit visit) {
  int element = 0;
  for (const auto& v : mesh.triangles) visit(element++, v);
  for (const auto& v : mesh.quads) visit(element++, v);
}

/// Returns the region of an element, triangles first.
inline int region_of(const Mesh& mesh, int element) {
  const int n_triangles = static_cast<int>(mesh.triangles.size());
  return element < n_triangles ? mesh.triangle_region[element] : mesh.quad_region[element - n_triangles];
}

/// Returns all sides of all elements, sorted by (lo, hi, element): the sides of one edge follow each other.
/// Indices must be in range.
inline std::vector<HalfEdge> sorted_half_edges(const Mesh& mesh) {
  std::vector<int> start(mesh.points.size() + 1, 0);
  for_each_element(mesh, [&](int, const auto& v) {
    assert(std::ranges::all_of(v, [&](int i) { return i >= 0 && i < static_cast<int>(mesh.points.size()); }));
    for (size_t k = 0; k < v.size(); ++k) ++start[std::min(v[k], v[(k + 1) % v.size()]) + 1];
  });
  for (size_t i = 1; i < start.size(); ++i) start[i] += start[i - 1];

  std::vector<HalfEdge> sides(start.back());
  std::vector<int> next = start;
  for_each_element(mesh, [&](int element, const auto& v) {
    for (size_t k = 0; k < v.size(); ++k) {
      const int a = v[k], b = v[(k + 1) % v.size()];
      sides[next[std::min(a, b)]++] = {std::min(a, b), std::max(a, b), element, a < b};
    }
  });
  parallel_ranges(mesh.points.size(), [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i)
      std::sort(sides.begin() + start[i], sides.begin() + start[i + 1],
                [](const HalfEdge& s, const HalfEdge& t) {
                  return std::tie(s.hi, s.element, s.forward) < std::tie(t.hi, t.element, t.forward);
                });
  });
  return sides;
}

/// Returns the sides of the edge between two points; empty if no element has it.
inline std::span<const HalfEdge> sides_of_edge(std::span<const HalfEdge> sides, int a, int b) {
  const auto key = std::pair(std::min(a, b), std::max(a, b));
  const auto first = std::lower_bound(sides.begin(), sides.end(), key, [](const HalfEdge& s, const auto& k) {
    return std::tie(s.lo, s.hi) < std::tie(k.first, k.second);
  });
  auto last = first;
  while (last != sides.end() && last->lo == key.first && last->hi == key.second) ++last;
  return {first, last};
}

/// Calls visit(span of its sides) once for each edge of sorted half-edges.
template <class Visit>
void for_each_edge(std::span<const HalfEdge> sides, Visit visit) {
  assert(std::ranges::is_sorted(sides, {}, [](const HalfEdge& s) { return std::pair(s.lo, s.hi); }));
  for (size_t i = 0; i < sides.size();) {
    size_t j = i + 1;
    while (j < sides.size() && sides[j].lo == sides[i].lo && sides[j].hi == sides[i].hi) ++j;
    visit(sides.subspan(i, j - i));
    i = j;
  }
}

}  // namespace delquad
