// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cad/weld_faces.h"

#include <algorithm>
#include <utility>

#include "base/sort_unique.h"
#include "geometry/mesh/half_edges.h"

namespace delquad::cad {

namespace {

using Side = std::array<int, 2>;

/// Returns the inner sides of faces, by face, on whose nodes another face has a side.
std::vector<std::pair<int, Side>> duplicate_sides(const Mesh& mesh,
                                                  const std::vector<std::vector<Side>>& boundary) {
  std::vector<std::pair<int, Side>> twins;
  const std::vector<HalfEdge> sides = sorted_half_edges(mesh);
  for_each_edge(sides, [&](std::span<const HalfEdge> edge) {
    const auto face_of = [&](const HalfEdge& side) { return mesh.triangle_region[side.element]; };
    const Side side{edge[0].lo, edge[0].hi};
    if (std::ranges::all_of(edge, [&](const HalfEdge& other) { return face_of(other) == face_of(edge[0]); }))
      return;
    for (const HalfEdge& half : edge)
      if (!std::ranges::binary_search(boundary[face_of(half)], side)) twins.emplace_back(face_of(half), side);
  });
  sort_unique(twins);
  return twins;
}

}  // namespace

std::vector<PointInside> split_duplicate_sides(Mesh& mesh, const std::vector<std::vector<Side>>& boundary) {
  std::vector<PointInside> added;
  for (const auto& [face, side] : duplicate_sides(mesh, boundary)) {
    const auto [a, b] = side;
    const int middle = static_cast<int>(mesh.points.size());
    mesh.points.push_back(0.5 * (mesh.points[a] + mesh.points[b]));
    added.push_back({middle, face});
    const std::size_t n = mesh.triangles.size();
    for (std::size_t t = 0; t < n; ++t) {
      if (mesh.triangle_region[t] != face) continue;
      auto& triangle = mesh.triangles[t];
      if (std::ranges::count(triangle, a) + std::ranges::count(triangle, b) < 2) continue;
      auto half = triangle;
      std::ranges::replace(triangle, b, middle);
      std::ranges::replace(half, a, middle);
      mesh.triangles.push_back(half);
      mesh.triangle_region.push_back(face);
    }
  }
  return added;
}

}  // namespace delquad::cad
