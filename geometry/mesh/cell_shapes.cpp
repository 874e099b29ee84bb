// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/mesh/cell_shapes.h"

namespace delquad {

Solid solid_at(const Mesh& mesh, std::size_t i) {
  Solid solid{};
  for_each_shape(mesh, [&](const SolidShape& shape, const auto& cells, const auto& volumes) {
    if (solid.shape != nullptr) return;
    if (i < cells.size())
      solid = {&shape, cells[i], volumes[i]};
    else
      i -= cells.size();
  });
  return solid;
}

std::array<int, 4> side_key(std::span<const int> nodes) {
  std::array<int, 4> key{-1, -1, -1, -1};
  std::ranges::copy(nodes, key.begin());
  std::ranges::sort(key);
  return key;
}

std::vector<SolidSide> sorted_sides(const Mesh& mesh) {
  std::vector<SolidSide> sides;
  int element = 0;
  for_each_shape(mesh, [&](const SolidShape& shape, const auto& cells, const auto& volumes) {
    sides.reserve(sides.size() + shape.sides.size() * cells.size());
    for (std::size_t i = 0; i < cells.size(); ++i, ++element)
      for (int s = 0; s < static_cast<int>(shape.sides.size()); ++s)
        sides.push_back({side_key(Solid{&shape, cells[i], volumes[i]}.side(s)), {element, s}});
  });
  std::ranges::stable_sort(sides, {}, &SolidSide::nodes);
  return sides;
}

bool same_turn(const std::array<int, 4>& a, const std::array<int, 4>& b) {
  const auto n = a[3] < 0 ? 3 : 4;
  const auto at = std::find(b.begin(), b.begin() + n, a[0]) - b.begin();
  for (int k = 1; k < n; ++k)
    if (a[k] != b[(at + k) % n]) return false;
  return true;
}

Vec3 middle_of_edge(const Mesh& mesh, int a, int b) {
  const std::array<int, 2> edge = {std::min(a, b), std::max(a, b)};
  const auto at = std::ranges::lower_bound(mesh.middle_nodes, edge, {}, &MiddleNode::edge);
  if (at != mesh.middle_nodes.end() && at->edge == edge) return at->at;
  return 0.5 * (mesh.points[a] + mesh.points[b]);
}

}  // namespace delquad
