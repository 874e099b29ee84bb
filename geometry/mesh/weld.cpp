#include "geometry/mesh/weld.h"

#include <cmath>
#include <map>
#include <numeric>
#include <tuple>

#include "base/sort_unique.h"
#include "geometry/mesh/half_edges.h"

namespace delquad {

namespace {

std::vector<int> ends_of_open_edges(const Mesh& mesh) {
  std::vector<int> ends;
  for_each_edge(sorted_half_edges(mesh), [&](std::span<const HalfEdge> edge) {
    if (edge.size() == 1 && edge[0].lo != edge[0].hi) ends.insert(ends.end(), {edge[0].lo, edge[0].hi});
  });
  sort_unique(ends);
  return ends;
}

}  // namespace

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
  using Cell = std::array<double, 3>;
  const auto cell_of = [&](const Vec3& p) {
    return Cell{std::floor(p.x / tolerance), std::floor(p.y / tolerance), std::floor(p.z / tolerance)};
  };
  std::map<Cell, std::vector<int>> kept;  // by cells as wide as the tolerance
  for (const int i : ends_of_open_edges(mesh)) {
    const Cell home = cell_of(points[i]);
    double nearest = tolerance;
    for (int k = 0; k < 27; ++k) {
      const auto cell = kept.find({home[0] + k % 3 - 1, home[1] + k / 3 % 3 - 1, home[2] + k / 9 - 1});
      if (cell == kept.end()) continue;
      for (const int j : cell->second) {
        const double distance = norm(points[j] - points[i]);
        if (distance > nearest || (distance == nearest && name[i] != i && name[i] < j)) continue;
        nearest = distance;
        name[i] = j;
      }
    }
    if (name[i] == i) kept[home].push_back(i);
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
}

}  // namespace delquad
