// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/mesh/double_nodes.h"

#include <algorithm>
#include <cassert>

namespace delquad {

void double_nodes(DisjointSets& joined, const std::vector<char>& opens, std::vector<int>& node,
                  std::vector<Vec3>& points) {
  assert(joined.size() == node.size() && opens.size() == node.size());
  std::vector<int> owner(points.size(), -1), of_set(node.size(), -1);
  for (std::size_t s = 0; s < node.size(); ++s) {
    if (!opens[s]) continue;
    const int v = node[s], set = joined.root(static_cast<int>(s));
    if (owner[v] < 0) owner[v] = set;
    if (of_set[set] < 0) {
      of_set[set] = owner[v] == set ? v : static_cast<int>(points.size());
      if (owner[v] != set) points.push_back(Vec3(points[v]));
    }
    node[s] = of_set[set];
  }
}

void add_lip_line(Mesh& mesh, int crack, const std::array<int, 2>& line, std::map<int, int>& lips) {
  const auto [lip, is_new] = lips.try_emplace(crack, static_cast<int>(mesh.curves.size()));
  if (is_new) {
    Entity entity = mesh.curves[crack];
    entity.tag = std::ranges::max_element(mesh.curves, {}, &Entity::tag)->tag + 1;
    mesh.curves.push_back(std::move(entity));
  }
  mesh.lines.push_back(line);
  mesh.line_curve.push_back(lip->second);
}

}  // namespace delquad
