// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/boundary_chains.h"

#include <algorithm>
#include <utility>

namespace delquad {

std::vector<std::vector<int>> join_edges(const std::vector<std::array<int, 2>>& edges) {
  struct Node {
    int in = 0, out = 0, next = -1;
    bool goes_on() const { return in == 1 && out == 1; }
  };
  std::map<int, Node> nodes;
  for (const auto& [a, b] : edges) ++nodes[a].out, ++nodes[b].in, nodes[a].next = b;
  std::vector<std::vector<int>> chains;
  const auto follow = [&](int from, int to) {
    std::vector<int>& chain = chains.emplace_back(std::vector{from, to});
    while (nodes[to].goes_on() && nodes[to].next >= 0)
      chain.push_back(to = std::exchange(nodes[to].next, -1));
  };
  for (const auto& [a, b] : edges)
    if (!nodes[a].goes_on()) follow(a, b);
  for (auto& [node, at] : nodes)  // what is left is closed
    if (at.goes_on() && at.next >= 0) follow(node, std::exchange(at.next, -1));
  return chains;
}

std::map<std::array<int, 2>, int> groups_of_lines(const Mesh& mesh, const std::vector<MeshGroup>& groups) {
  std::map<std::array<int, 2>, int> result;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    if (groups[g].dim != 1) continue;
    for (const int l : groups[g].items) {
      const auto [lo, hi] = std::minmax(mesh.lines[l][0], mesh.lines[l][1]);
      result[{lo, hi}] = static_cast<int>(g);
    }
  }
  return result;
}

std::vector<BoundarySide> boundary_sides(const Mesh& mesh, const std::vector<MeshGroup>& groups) {
  const std::map<std::array<int, 2>, int> group_of = groups_of_lines(mesh, groups);
  std::vector<BoundarySide> result;
  for_each_edge(sorted_half_edges(mesh), [&](std::span<const HalfEdge> at) {
    if (at.size() != 1) return;
    const auto group = group_of.find({at[0].lo, at[0].hi});
    const auto [element, side] = cell_side(mesh, at[0]);
    result.push_back({at[0].run(), element, side, group == group_of.end() ? -1 : group->second});
  });
  std::ranges::sort(result, {}, &BoundarySide::run);
  return result;
}

std::vector<CoastPiece> coast_pieces(const Mesh& mesh) {
  const std::vector<MeshGroup> groups = mesh_groups(mesh, {one_line_label});
  std::vector<std::array<int, 2>> runs;
  std::map<std::array<int, 2>, std::string> name_of;
  for (const BoundarySide& side : boundary_sides(mesh, groups)) {
    runs.push_back(side.run);
    name_of[side.run] = side.group < 0 ? "" : groups[side.group].label;
  }
  std::vector<CoastPiece> pieces;
  for (std::vector<int>& loop : join_edges(runs)) {
    const std::size_t n = loop.size() - 1;
    const auto name_at = [&](std::size_t i) -> const std::string& {
      return name_of.at({loop[i], loop[i + 1]});
    };
    double area = 0, length = 0;
    bool any_open = false;
    for (std::size_t i = 0; i < n; ++i) {
      const Vec3 first = mesh.points[loop[0]], a = mesh.points[loop[i]], b = mesh.points[loop[i + 1]];
      area += cross(a - first, b - first).z;
      length += norm(b - a);
      any_open = any_open || name_contains(name_at(i), "open");
    }
    // A barrier in the water has no area: both of its sides are there.
    constexpr double kNoArea = 1e-9;
    if (area <= kNoArea * length * length && !any_open) {
      loop.pop_back();
      pieces.push_back({loop, name_of.at({loop[0], loop[1]}), false, true});
      continue;
    }
    std::size_t begin = 0;
    while (begin < n && name_at(begin) == name_at(n - 1)) ++begin;
    const bool single = begin == n;
    if (!single && loop.front() == loop.back()) {
      std::rotate(loop.begin(), loop.begin() + static_cast<std::ptrdiff_t>(begin), loop.end() - 1);
      loop.back() = loop.front();
    }
    for (std::size_t i = 0; i < n; ++i) {
      if (i == 0 || name_at(i) != name_at(i - 1) || (single && i == n / 2))
        pieces.push_back({{loop[i]}, name_at(i), name_contains(name_at(i), "open"), false});
      pieces.back().nodes.push_back(loop[i + 1]);
    }
  }
  std::ranges::stable_partition(pieces, &CoastPiece::open);
  return pieces;
}

}  // namespace delquad
