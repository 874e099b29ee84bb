// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/volume/fill_steps.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "base/text.h"
#include "geometry/mesh/cell_shapes.h"

namespace delquad {

namespace {

using Edge = std::array<int, 2>;

/// Least Jacobian of a curved tetrahedron, as a part of the straight one's.
constexpr double kLeastOfStraight = 0.05;
/// Middle nodes go half the way to the straight edge so often, then all the way.
constexpr int kHalvings = 3;

/// Middle nodes that are nearer to the straight edge, in its lengths, count as straight.
constexpr double kStraight = 1e-9;

Edge edge_of(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

/// Returns a lower bound of the Jacobian of a quadratic tetrahedron as a part of the straight one's: the
/// least Bernstein coefficient. Columns of the Jacobian are linear, so its determinant is cubic.
double least_jacobian(const Mesh& mesh, const std::array<int, 4>& tet) {
  std::array<std::array<Vec3, 4>, 4> columns;  // by direction and corner
  const auto slope = [&](int k, int at) {
    const Vec3& corner = mesh.points[tet[k]];
    return at == k ? 3 * corner : 4 * middle_of_edge(mesh, tet[k], tet[at]) - corner;
  };
  for (int k = 1; k < 4; ++k)
    for (int at = 0; at < 4; ++at) columns[k][at] = slope(k, at) - slope(0, at);
  const auto volume = [](const Vec3& a, const Vec3& b, const Vec3& c) { return dot(cross(a, b), c); };
  std::map<std::array<int, 3>, std::pair<double, int>> sums;  // by sorted corners
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j)
      for (int k = 0; k < 4; ++k) {
        std::array<int, 3> corners = {i, j, k};
        std::ranges::sort(corners);
        auto& [sum, n] = sums[corners];
        sum += volume(columns[1][i], columns[2][j], columns[3][k]), ++n;
      }
  const Vec3& p = mesh.points[tet[0]];
  const double straight = volume(mesh.points[tet[1]] - p, mesh.points[tet[2]] - p, mesh.points[tet[3]] - p);
  double least = 1;
  for (const auto& [corners, value] : sums) least = std::min(least, value.first / value.second / straight);
  return least;
}

}  // namespace

void place_middle_nodes(Mesh& cells, const Mesh& skin, const std::vector<int>& number, ReadNotes* notes) {
  std::map<Edge, Vec3> middles;
  for (std::size_t q = 0; q < skin.quads.size(); ++q) {
    const int* nodes = &skin.quad_nodes[5 * q];
    const auto& quad = skin.quads[q];
    for (int k = 0; k < 4; ++k)
      middles[edge_of(number[quad[k]], number[quad[(k + 1) % 4]])] = skin.points[nodes[k]];
    const auto& half = cells.triangles[2 * q];
    middles[edge_of(half[0], half[2])] = skin.points[nodes[4]];
  }
  for (const auto& [edge, at] : middles) cells.middle_nodes.push_back({edge, at});
  std::map<Edge, int> moved;
  for (bool any = true; any;) {
    any = false;
    std::set<Edge> folded;
    for (const auto& tet : cells.tetrahedra)
      if (least_jacobian(cells, tet) < kLeastOfStraight)
        for (const auto& [i, j] : solid_shape(CellShape::kTetrahedron).edges)
          folded.insert(edge_of(tet[i], tet[j]));
    for (auto& [edge, at] : cells.middle_nodes) {
      if (!folded.contains(edge) || moved[edge] > kHalvings) continue;
      const Vec3 &from = cells.points[edge[0]], &to = cells.points[edge[1]], straight = 0.5 * (from + to);
      if (norm(at - straight) < kStraight * norm(to - from)) continue;
      at = ++moved[edge] > kHalvings ? straight : 0.5 * (at + straight);
      any = true;
    }
  }
  std::erase_if(moved, [](const auto& of) { return of.second == 0; });
  if (moved.empty() || notes == nullptr) return;
  const Edge& first = moved.begin()->first;
  notes->push_back(
      fmt::format("off the model: {}, the first at {}: tetrahedra would fold there; smaller sizes help",
                  counted(static_cast<long long>(moved.size()), "middle node"),
                  show_point(middle_of_edge(cells, first[0], first[1]))));
}

}  // namespace delquad
