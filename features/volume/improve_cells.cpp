// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <ranges>
#include <span>
#include <utility>

#include "base/sort_unique.h"
#include "features/volume/body_parts.h"
#include "features/volume/cell_mesh.h"
#include "geometry/mesh/cell_shapes.h"

namespace delquad {

namespace {

/// A change must raise the least quality by more than this, so that changes end.
constexpr double kGain = 1e-3;
/// Cells below this quality may move vertices of hexahedra and prisms, and divide these.
constexpr double kPoor = 0.1;
/// Cells below this quality are improved.
constexpr double kWanted = 0.42;
/// Collapses that make no cell worse than this remove vertices.
constexpr double kEnough = 0.25;

double mean_edge(const CellMesh& mesh, int v) {
  double sum = 0;
  int n = 0;
  for (const int c : mesh.at(v))
    for (const int w : nodes_of(mesh.cells()[c]))
      if (w != v) sum += norm(mesh.points()[w] - mesh.points()[v]), ++n;
  return n > 0 ? sum / n : 0;
}

/// Returns the cells of a list below a quality, worst first.
std::vector<std::pair<double, int>> cells_below(const CellMesh& mesh, const auto& cells, double quality) {
  std::vector<std::pair<double, int>> worst;
  for (const int c : cells)
    if (mesh.is_alive(c) && mesh.quality(c) < quality) worst.emplace_back(mesh.quality(c), c);
  std::ranges::sort(worst);
  return worst;
}
auto all_cells(const CellMesh& mesh) { return std::views::iota(0, static_cast<int>(mesh.cells().size())); }

/// Returns the gradients of the qualities of the cells at a vertex that are in a band above the least, by
/// differences over a length.
std::vector<Vec3> gradients(const CellMesh& mesh, int v, double band, double length) {
  constexpr std::size_t kMost = 8;
  auto worst = cells_below(mesh, mesh.at(v), mesh.least(mesh.at(v)) + band);
  if (worst.size() > kMost) worst.resize(kMost);
  std::vector<Vec3> all;
  for (const auto& [quality, c] : worst) {
    const auto slope = [&, c = c, q = quality](const Vec3& step) {
      return (mesh.quality_with(mesh.cells()[c], v, mesh.points()[v] + step) - q) / length;
    };
    all.push_back({slope({length, 0, 0}), slope({0, length, 0}), slope({0, 0, length})});
  }
  return all;
}

/// Returns the shortest vector of the convex hull of vectors, by the method of Frank and Wolfe.
Vec3 shortest(const std::vector<Vec3>& vectors) {
  constexpr int kSteps = 30;
  Vec3 at = vectors[0];
  for (int i = 0; i < kSteps; ++i) {
    const Vec3 to = *std::ranges::min_element(vectors, {}, [&](const Vec3& g) { return dot(g, at); });
    const Vec3 way = at - to;
    const double length2 = dot(way, way), down = dot(at, way);
    if (!(down > 1e-12 * length2)) break;
    at = at - std::min(1.0, down / length2) * way;
  }
  return at;
}

double least_with(const CellMesh& mesh, int v, const Vec3& x, double enough) {
  double least = 1;
  for (const int c : mesh.at(v)) {
    least = std::min(least, mesh.quality_with(mesh.cells()[c], v, x));
    if (least <= enough) break;
  }
  return least;
}

/// Replaces the tetrahedra around an edge by tetrahedra without it, if that raises their least quality.
bool remove_edge(CellMesh& mesh, int a, int b) {
  constexpr int kMost = 8;
  bool is_open = false;
  const std::vector<int> ring = mesh.ring(a, b, is_open);
  const int n = static_cast<int>(ring.size());
  if (is_open || n < 3 || n > kMost) return false;
  const auto pair_of = [&](int i, int j, int k) {
    return std::array{cell_of(std::array{ring[i], ring[j], ring[k], b}),
                      cell_of(std::array{ring[i], ring[k], ring[j], a})};
  };
  // The best triangulation of the ring's part from i to j, by dynamic programming.
  double best[kMost][kMost];
  int middle[kMost][kMost];
  for (int length = 1; length < n; ++length)
    for (int i = 0; i + length < n; ++i) {
      const int j = i + length;
      best[i][j] = length == 1 ? 1 : -2;
      for (int k = i + 1; k < j; ++k) {
        const auto pair = pair_of(i, k, j);
        const double value =
            std::min({best[i][k], best[k][j], mesh.quality_with(pair[0]), mesh.quality_with(pair[1])});
        if (value > best[i][j]) best[i][j] = value, middle[i][j] = k;
      }
    }
  const std::vector<int> old = mesh.cells_with({a, b});
  if (!(best[0][n - 1] > mesh.least(old) + kGain)) return false;
  std::vector<Cell> by;
  std::vector<std::pair<int, int>> parts = {{0, n - 1}};
  while (!parts.empty()) {
    const auto [i, j] = parts.back();
    parts.pop_back();
    if (j - i < 2) continue;
    const int k = middle[i][j];
    for (const Cell& cell : pair_of(i, k, j)) by.push_back(cell);
    parts.insert(parts.end(), {{i, k}, {k, j}});
  }
  return mesh.replace(old, by, kGain);
}

/// Replaces a pyramid and one on the other side of its quad by four tetrahedra around the line of their
/// apices.
bool open_quad(CellMesh& mesh, int c) {
  const Cell cell = mesh.cells()[c];
  for (const int other : mesh.cells_with({cell[0], cell[1], cell[2], cell[3]})) {
    const Cell& beyond = mesh.cells()[other];
    if (other == c || !is_pyramid(beyond)) continue;
    std::vector<Cell> by;
    for (int k = 0; k < 4; ++k)
      by.push_back(cell_of(std::array{cell[k], cell[(k + 1) % 4], beyond[4], cell[4]}));
    if (mesh.replace({c, other}, by, kGain)) return true;
  }
  return false;
}

/// Moves a free vertex onto another one, and removes the cells between, if the least quality grows by a gain.
bool collapse(CellMesh& mesh, int u, int v, double gain) {
  std::vector<Cell> by;
  const std::vector<int> old = mesh.at(u);
  for (const int c : old) {
    Cell cell = mesh.cells()[c];
    if (has_corner(cell, v)) {
      if (is_pyramid(cell)) return false;
      continue;
    }
    std::ranges::replace(cell, u, v);
    by.push_back(cell);
  }
  return mesh.replace(old, by, gain);
}

/// Tries all changes at a cell. Returns whether one was made.
bool improve_cell(CellMesh& mesh, int c) {
  const Cell cell = mesh.cells()[c];
  const int n = n_corners(cell);
  bool moved = false;
  for (int k = 0; k < n; ++k)
    if (mesh.quality(c) < kPoor ? !mesh.is_fixed(cell[k]) : mesh.is_free(cell[k]))
      moved |= relocate(mesh, cell[k]) > kGain;
  if (mesh.quality(c) >= kWanted) return true;
  if (is_pyramid(cell) && open_quad(mesh, c)) return true;
  for (int i = 0; i < n && n == 4; ++i)
    for (int j = i + 1; j < n; ++j)
      if (remove_edge(mesh, cell[i], cell[j])) return true;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      if (i != j && mesh.is_free(cell[i]) && collapse(mesh, cell[i], cell[j], kGain)) return true;
  return moved;
}

/// Improves the cells that list() returns, worst first, until nothing changes or rounds end.
void improve_all(CellMesh& mesh, int rounds, const auto& list) {
  for (bool changed = true; changed && rounds > 0; --rounds) {
    changed = false;
    for (const auto& [quality, c] : cells_below(mesh, list(), kWanted))
      if (mesh.is_alive(c) && mesh.quality(c) < kWanted) changed |= improve_cell(mesh, c);
  }
}

/// Divides a hexahedron or prism by its center.
int divide(CellMesh& mesh, int c) {
  const Cell cell = mesh.cells()[c];
  const std::span<const int> nodes = nodes_of(cell);
  const int m = mesh.add_point(middle_of(mesh.points(), nodes));
  mesh.remove(c);
  const Solid solid{&solid_shape(nodes.size() == 8 ? CellShape::kHexahedron : CellShape::kPrism), nodes};
  for (int k = 0; k < static_cast<int>(solid.shape->sides.size()); ++k) {
    const auto [q, r, s, t] = solid.side(k);
    mesh.add(t < 0 ? cell_of(std::array{q, s, r, m}) : cell_of(std::array{q, t, s, r, m}));
  }
  return m;
}

/// Returns the cells at the vertices of a list.
std::vector<int> cells_at(const CellMesh& mesh, const std::vector<int>& vertices) {
  std::vector<int> cells;
  for (const int v : vertices) cells.insert(cells.end(), mesh.at(v).begin(), mesh.at(v).end());
  sort_unique(cells);
  return cells;
}

/// Divides hexahedra and prisms beside poor cells.
void divide_blocks(CellMesh& mesh) {
  constexpr int kRounds = 3, kLocalRounds = 3;
  for (int round = 0; round < kRounds; ++round) {
    bool changed = false;
    for (const auto& [quality, c] : cells_below(mesh, all_cells(mesh), kPoor)) {
      if (!mesh.is_alive(c) || mesh.quality(c) >= kPoor) continue;
      const Cell cell = mesh.cells()[c];
      const std::vector<int> corners(nodes_of(cell).begin(), nodes_of(cell).end());
      // Blocks by the number of common vertices, most first.
      std::vector<std::pair<int, int>> blocks;
      for (const int b : cells_at(mesh, corners)) {
        if (!is_block(mesh.cells()[b])) continue;
        const auto shared =
            std::ranges::count_if(corners, [&](int v) { return has_corner(mesh.cells()[b], v); });
        if (b == c || shared > 1) blocks.emplace_back(-static_cast<int>(shared), b);
      }
      std::ranges::sort(blocks);
      double best = mesh.least(cells_at(mesh, corners)) + kGain;
      int chosen = -1;
      const auto attempt = [&](int b) {
        std::vector<int> around = corners;
        around.push_back(divide(mesh, b));
        improve_all(mesh, kLocalRounds, [&] { return cells_at(mesh, around); });
        return mesh.least(cells_at(mesh, around));
      };
      for (const auto& [shared, b] : blocks) {
        const std::size_t state = mesh.state();
        const double least = attempt(b);
        mesh.undo(state);
        if (least > best) best = least, chosen = b;
        if (best >= kPoor) break;
      }
      if (chosen < 0) continue;
      attempt(chosen);
      changed = true;
    }
    if (!changed) break;
  }
}

/// Removes free vertices by collapses of edges.
void coarsen(CellMesh& mesh) {
  for (int v = 0; v < static_cast<int>(mesh.points().size()); ++v) {
    if (mesh.at(v).empty() || !mesh.is_free(v)) continue;
    std::vector<int> beside;
    for (const int c : mesh.at(v))
      beside.insert(beside.end(), nodes_of(mesh.cells()[c]).begin(), nodes_of(mesh.cells()[c]).end());
    sort_unique(beside);
    const double gain = std::min(0.0, kEnough - mesh.least(mesh.at(v)));
    for (const int w : beside)
      if (w != v && collapse(mesh, v, w, gain)) break;
  }
}

}  // namespace

double relocate(CellMesh& mesh, int v) {
  constexpr int kMoves = 12, kHalvings = 8, kHalvingsIfBad = 24;
  constexpr double kFirst = 0.25, kDifference = 1e-6, kBand = 0.05, kLeastBand = 1e-5, kBad = 0.05;
  const double before = mesh.least(mesh.at(v)), length = mean_edge(mesh, v);
  double band = kBand;
  for (int i = 0; i < kMoves && length > 0; ++i) {
    const Vec3 way = shortest(gradients(mesh, v, band, kDifference * length));
    const double steepness = norm(way), least = mesh.least(mesh.at(v));
    const double wanted = least + kGain * std::min(0.25, std::abs(least));
    double step = kFirst * length;
    int left = steepness > 0 ? least > kBad ? kHalvings : kHalvingsIfBad : 0;
    for (; left > 0; --left, step /= 2) {
      const Vec3 x = mesh.points()[v] + (step / steepness) * way;
      if (!(least_with(mesh, v, x, wanted) > wanted)) continue;
      mesh.move(v, x);
      break;
    }
    if (left > 0) continue;
    if (least > kGain || band < kLeastBand) break;
    band /= 10;  // needles have qualities that change over shorter lengths
  }
  return mesh.least(mesh.at(v)) - before;
}

void improve(CellMesh& mesh) {
  constexpr int kRounds = 10;
  const auto all = [&] { return all_cells(mesh); };
  improve_all(mesh, kRounds, all);
  divide_blocks(mesh);
  coarsen(mesh);
  improve_all(mesh, kRounds, all);
}

}  // namespace delquad
