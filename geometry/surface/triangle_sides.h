// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "geometry/mesh/half_edges.h"

// This header numbers sides of triangles: side 3 t + k of triangle t runs from its vertex k to the next.
// Features of triangulations use it.
namespace delquad {

inline int side_start(const Mesh& mesh, int side) { return mesh.triangles[side / 3][side % 3]; }
inline int side_end(const Mesh& mesh, int side) { return mesh.triangles[side / 3][(side % 3 + 1) % 3]; }
inline int next_side(int side) { return side % 3 == 2 ? side - 2 : side + 1; }

/// Returns the number of a half-edge of a triangle.
inline int side_number(const Mesh& mesh, const HalfEdge& half) {
  const auto [start, end] = half.run();
  int side = 3 * half.element;
  while (side_start(mesh, side) != start || side_end(mesh, side) != end) ++side;
  return side;
}

/// Returns for each side the other side of its edge, in either direction; -1: none, or more than one.
inline std::vector<int> side_twins(const Mesh& mesh) {
  std::vector<int> twin(3 * mesh.triangles.size(), -1);
  for_each_edge(sorted_half_edges(mesh), [&](std::span<const HalfEdge> edge) {
    if (edge.size() != 2) return;
    const int s = side_number(mesh, edge[0]), t = side_number(mesh, edge[1]);
    twin[s] = t;
    twin[t] = s;
  });
  return twin;
}

/// Returns the same, but only if both sides have opposite directions, so that their triangles agree.
inline std::vector<int> agreeing_twins(const Mesh& mesh) {
  std::vector<int> twin = side_twins(mesh);
  for (int s = 0; s < static_cast<int>(twin.size()); ++s)
    if (twin[s] > s && side_start(mesh, s) == side_start(mesh, twin[s])) twin[s] = twin[twin[s]] = -1;
  return twin;
}

}  // namespace delquad
