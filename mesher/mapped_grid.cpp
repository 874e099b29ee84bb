#include "mesher/mapped_grid.h"

#include <algorithm>
#include <map>
#include <vector>

#include "base/predicates.h"

namespace delquad {
namespace {

/// The points of a side, and their lengths from its beginning as parts of the whole.
struct GridSide {
  std::vector<int> points;
  std::vector<double> parts{0};
};

GridSide grid_side(const PatchBoundary& boundary, int from, int to) {
  const int n = static_cast<int>(boundary.points.size());
  GridSide side{{from}};
  for (int i = from; i != to; i = (i + 1) % n) {
    const int next = (i + 1) % n;
    side.parts.push_back(side.parts.back() + norm(boundary.points[next] - boundary.points[i]));
    side.points.push_back(next);
  }
  for (double& part : side.parts) part /= side.parts.back() > 0 ? side.parts.back() : 1;
  return side;
}

void reverse(GridSide& side) {
  std::ranges::reverse(side.points);
  std::ranges::reverse(side.parts);
  for (double& part : side.parts) part = 1 - part;
}

/// The point (i, j) between the sides.
Vec2 between(const std::vector<Vec2>& p, const GridSide& bottom, const GridSide& right, const GridSide& top,
             const GridSide& left, std::size_t i, std::size_t j) {
  const double sb = bottom.parts[i], st = top.parts[i], tl = left.parts[j], tr = right.parts[j];
  const double det = 1 - (st - sb) * (tr - tl);
  const double u = ((1 - tl) * sb + tl * st) / det, v = ((1 - sb) * tl + sb * tr) / det;
  const Vec2 a = p[bottom.points.front()], b = p[bottom.points.back()], c = p[top.points.back()],
             d = p[top.points.front()];
  return (1 - v) * p[bottom.points[i]] + v * p[top.points[i]] + (1 - u) * p[left.points[j]] +
         u * p[right.points[j]] - ((1 - u) * (1 - v) * a + u * (1 - v) * b + u * v * c + (1 - u) * v * d);
}

bool are_convex(const QuadPatch& grid) {
  return std::ranges::all_of(grid.quads, [&](const std::array<int, 4>& q) {
    for (int k = 0; k < 4; ++k)
      if (!(orient2d(grid.points[q[k]], grid.points[q[(k + 1) % 4]], grid.points[q[(k + 2) % 4]]) > 0))
        return false;
    return true;
  });
}

/// Across the side from a to b; neighbours by sides.
void set_neighbours(TriPatch& tri) {
  std::map<std::array<int, 2>, std::array<int, 2>> open;
  tri.neighbours.assign(tri.triangles.size(), {-1, -1, -1});
  for (int t = 0; t < static_cast<int>(tri.triangles.size()); ++t)
    for (int k = 0; k < 3; ++k) {
      const int a = tri.triangles[t][(k + 1) % 3], b = tri.triangles[t][(k + 2) % 3];
      if (const auto at = open.find({b, a}); at != open.end()) {
        const auto [u, m] = at->second;
        tri.neighbours[t][k] = u;
        tri.neighbours[u][m] = t;
      } else {
        open[{a, b}] = {t, k};
      }
    }
}

}  // namespace

std::optional<QuadPatch> mapped_grid(const PatchBoundary& boundary, const std::array<int, 4>& corners) {
  GridSide bottom = grid_side(boundary, corners[0], corners[1]),
           right = grid_side(boundary, corners[1], corners[2]),
           top = grid_side(boundary, corners[2], corners[3]),
           left = grid_side(boundary, corners[3], corners[0]);
  reverse(top);
  reverse(left);
  const std::size_t n = bottom.points.size(), m = left.points.size();
  if (top.points.size() != n || right.points.size() != m) return std::nullopt;
  QuadPatch grid;
  grid.points = boundary.points;
  grid.n_boundary = static_cast<int>(boundary.points.size());
  const auto node = [&](std::size_t i, std::size_t j) {
    if (j == 0) return bottom.points[i];
    if (j + 1 == m) return top.points[i];
    if (i == 0) return left.points[j];
    if (i + 1 == n) return right.points[j];
    return grid.n_boundary + static_cast<int>((j - 1) * (n - 2) + i - 1);
  };
  for (std::size_t j = 1; j + 1 < m; ++j)
    for (std::size_t i = 1; i + 1 < n; ++i)
      grid.points.push_back(between(boundary.points, bottom, right, top, left, i, j));
  for (std::size_t j = 0; j + 1 < m; ++j)
    for (std::size_t i = 0; i + 1 < n; ++i)
      grid.quads.push_back({node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)});
  if (!are_convex(grid)) return std::nullopt;
  return grid;
}

PatchMesh grid_as(PatchForm form, const QuadPatch& grid) {
  PatchMesh mesh;
  mesh.form = form;
  if (form == PatchForm::kQuads) {
    mesh.quads = grid;
    return mesh;
  }
  mesh.triangles.points = grid.points;
  mesh.triangles.n_boundary = grid.n_boundary;
  for (const auto& [a, b, c, d] : grid.quads) {
    mesh.triangles.triangles.push_back({a, b, c});
    mesh.triangles.triangles.push_back({a, c, d});
  }
  set_neighbours(mesh.triangles);
  return mesh;
}

}  // namespace delquad
