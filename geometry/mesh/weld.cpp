// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/mesh/weld.h"

#include <fmt/format.h>

#include <cmath>
#include <numeric>
#include <set>
#include <tuple>

#include "base/text.h"
#include "geometry/mesh/cell_shapes.h"
#include "geometry/mesh/drop_unused_points.h"
#include "geometry/mesh/half_edges.h"
#include "geometry/mesh/keep_elements.h"

namespace delquad {

PointNames names_of_equal_points(const Mesh& mesh) {
  const std::vector<Vec3>& points = mesh.points;
  std::vector<int> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int i, int j) {
    const Vec3 &p = points[i], &q = points[j];
    return std::tie(p.x, p.y, p.z, i) < std::tie(q.x, q.y, q.z, j);
  });
  PointNames name(points.size());
  for (size_t k = 0; k < order.size(); ++k) {
    const bool same = k > 0 && points[order[k]] == points[order[k - 1]];
    name[order[k]] = same ? name[order[k - 1]] : order[k];
  }
  return name;
}

PointNames names_at_open_edges(const Mesh& mesh, double tolerance) {
  const std::vector<Vec3>& points = mesh.points;
  PointNames name(points.size());
  std::iota(name.begin(), name.end(), 0);
  if (!(tolerance > 0)) return name;
  const std::vector<HalfEdge> sides = sorted_half_edges(mesh);
  enum Kind : char { kUnused, kInside, kOpen };
  std::vector<Kind> kind(points.size(), kUnused);
  bool has_open = false;
  for_each_edge(sides, [&](std::span<const HalfEdge> edge) {
    const bool is_open = edge.size() == 1 && edge[0].lo != edge[0].hi;
    has_open |= is_open;
    for (const int v : {edge[0].lo, edge[0].hi}) kind[v] = std::max(kind[v], is_open ? kOpen : kInside);
  });
  if (!has_open) return name;
  using Cell = std::array<double, 3>;  // as wide as the tolerance
  const auto cell_of = [&](const Vec3& p) {
    return Cell{std::floor(p.x / tolerance), std::floor(p.y / tolerance), std::floor(p.z / tolerance)};
  };
  std::vector<std::pair<Cell, int>> others;
  for (size_t i = 0; i < points.size(); ++i)
    if (kind[i] != kUnused) others.emplace_back(cell_of(points[i]), static_cast<int>(i));
  std::sort(others.begin(), others.end());
  for (int i = 0; i < static_cast<int>(points.size()); ++i) {
    if (kind[i] != kOpen) continue;
    const Cell home = cell_of(points[i]);
    double nearest = tolerance;
    for (int k = 0; k < 9; ++k) {
      const double x = home[0] + k % 3 - 1, y = home[1] + k / 3 - 1;
      auto at = std::lower_bound(others.begin(), others.end(), std::pair(Cell{x, y, home[2] - 1}, 0));
      for (; at != others.end() && at->first <= Cell{x, y, home[2] + 1}; ++at) {
        const int j = at->second;
        if (kind[j] == kOpen ? j >= i || name[j] != j : !sides_of_edge(sides, i, j).empty()) continue;
        const double distance = norm(points[j] - points[i]);
        if (distance > nearest || (distance == nearest && name[i] != i && name[i] < j)) continue;
        nearest = distance;
        name[i] = j;
      }
    }
  }
  return name;
}

void rename_points(Mesh& mesh, const PointNames& names) {
  const auto rename = [&](auto& elements) {
    for (auto& v : elements) {
      for (int& i : v) i = names[i];
    }
  };
  rename(mesh.lines);
  rename(mesh.triangles);
  rename(mesh.quads);
  for_each_shape(mesh, [&](const SolidShape&, auto& cells, const auto&) { rename(cells); });
  renumber_nodes(mesh, names);
}

namespace {

/// Returns the number of replaced points, "2 points at open edges", and the place of the first one.
std::array<std::string, 2> renamed_in(const Mesh& mesh, const PointNames& names) {
  int count = 0;
  Vec3 first;
  for (size_t i = 0; i < names.size(); ++i)
    if (names[i] != static_cast<int>(i) && count++ == 0) first = mesh.points[i];
  if (count == 0) return {};
  return {counted(count, "point") + " at open edges", show_point(first)};
}

}  // namespace

std::string weld_open_edges(Mesh& mesh, double tolerance) {
  const PointNames names = names_at_open_edges(mesh, tolerance);
  const auto [count, place] = renamed_in(mesh, names);
  if (count.empty()) return {};
  rename_points(mesh, names);
  std::set<std::pair<int, int>> seen;
  keep_lines(mesh,
             [&](size_t l) { return seen.insert(std::minmax(mesh.lines[l][0], mesh.lines[l][1])).second; });
  drop_unused_points(mesh);
  return fmt::format("welded {} to others (the first at {})", count, place);
}

std::string describe_unjoined(const Mesh& mesh) {
  constexpr double kCoincident = 1e-6;  // of the diagonal
  const auto [count, place] = renamed_in(mesh, names_at_open_edges(mesh, kCoincident * diagonal(mesh)));
  if (count.empty()) return {};
  return fmt::format(
      "{} coincide with others within {:g} of the diagonal and are not joined (the first at {}): a crack, or "
      "a torn mesh; --weld {:g} joins them [torn-mesh]",
      count, kCoincident, place, kCoincident);
}

}  // namespace delquad
