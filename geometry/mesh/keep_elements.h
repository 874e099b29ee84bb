// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cassert>
#include <cstddef>
#include <span>
#include <vector>

#include "delquad/mesh.h"
#include "geometry/mesh/half_edges.h"

// This header removes elements from meshes. Most modules use it.

namespace delquad {

/// Keeps the elements of one kind for which keep(index) returns true, with their entities, in their order.
/// Returns the number of removed ones. Calls of keep() are in this order, and may change the element.
template <class Elements, class Keep>
std::size_t keep_elements(Elements& elements, std::vector<int>& entity_of, Keep keep) {
  assert(elements.size() == entity_of.size());
  std::size_t kept = 0;
  for (std::size_t i = 0; i < elements.size(); ++i) {
    if (!keep(i)) continue;
    elements[kept] = elements[i];
    entity_of[kept++] = entity_of[i];
  }
  const std::size_t gone = elements.size() - kept;
  elements.resize(kept);
  entity_of.resize(kept);
  return gone;
}
template <class Keep>
std::size_t keep_lines(Mesh& mesh, Keep keep) {
  return keep_elements(mesh.lines, mesh.line_curve, keep);
}
template <class Keep>
std::size_t keep_triangles(Mesh& mesh, Keep keep) {
  return keep_elements(mesh.triangles, mesh.triangle_region, keep);
}

/// Removes the lines that are no sides of elements. Returns their number. `sides` has the
/// sorted_half_edges().
inline std::size_t drop_stray_lines(Mesh& mesh, std::span<const HalfEdge> sides) {
  return keep_lines(
      mesh, [&](std::size_t l) { return !sides_of_edge(sides, mesh.lines[l][0], mesh.lines[l][1]).empty(); });
}

}  // namespace delquad
