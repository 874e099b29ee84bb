// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/volume/cell_mesh.h"

#include <algorithm>
#include <numbers>
#include <span>

#include "features/volume/body_parts.h"
#include "geometry/mesh/cell_shapes.h"
#include "metrics/cells.h"

namespace delquad {

namespace {

/// Hexahedra and prisms above this scaled Jacobian count as good.
constexpr double kGoodBlock = 0.2;

double triple(const Vec3& a, const Vec3& b, const Vec3& c) { return dot(cross(a, b), c); }

double quality_of_tetrahedron(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 u = b - a, v = c - a, w = d - a;
  const double lu = norm(u), lv = norm(v), lw = norm(w), bc = norm(c - b), cd = norm(d - c), db = norm(b - d);
  const double most = std::max({lu * lv * lw, lu * bc * db, lv * bc * cd, lw * cd * db});
  const double least = std::min({lu * lv * lw, lu * bc * db, lv * bc * cd, lw * cd * db});
  const double det = triple(u, v, w);
  return most > 0 ? std::numbers::sqrt2 * det / (det > 0 || least == 0 ? most : least) : 0;
}

double quality_of_pyramid(std::span<const Vec3> p) {
  std::array<Vec3, 4> side, up;
  for (int k = 0; k < 4; ++k) {
    side[k] = direction_of(p[(k + 1) % 4] - p[k]);
    up[k] = direction_of(p[4] - p[k]);
  }
  double least = 1;
  for (int k = 0; k < 4; ++k) {
    const double base = triple(side[(k + 1) % 4], (-1.0) * side[k], up[(k + 1) % 4]);
    least = std::min({least, base, triple(up[k], up[(k + 1) % 4], up[(k + 2) % 4])});
  }
  return std::numbers::sqrt2 * least;
}

}  // namespace

bool CellMesh::is_free(int v) const {
  return !fixed_[v] && std::ranges::none_of(at_[v], [&](int c) { return is_block(cells_[c]); });
}

double CellMesh::quality_with(const Cell& cell, int v, const Vec3& x) const {
  std::array<Vec3, 8> p;
  const int n = n_corners(cell);
  for (int k = 0; k < n; ++k) p[k] = cell[k] == v ? x : points_[cell[k]];
  if (n == 4) return quality_of_tetrahedron(p[0], p[1], p[2], p[3]);
  const std::span<const Vec3> corners = std::span(p).first(n);
  if (n == 5) return quality_of_pyramid(corners);
  const double jacobian = scaled_jacobian(corners);
  return jacobian < kGoodBlock || !is_positive(corners) ? -1 : 1;
}

int CellMesh::add_point(const Vec3& p) {
  points_.push_back(p);
  at_.emplace_back();
  fixed_.push_back(0);
  return static_cast<int>(points_.size()) - 1;
}

void CellMesh::add(const Cell& cell) {
  const int c = static_cast<int>(cells_.size());
  cells_.push_back(cell);
  quality_.push_back(quality_with(cell));
  for (const int v : nodes_of(cell)) at_[v].push_back(c);
  changes_.push_back({c, -1, {-1}, {}});
}

void CellMesh::remove(int c) {
  changes_.push_back({c, -1, cells_[c], {}});
  for (const int v : nodes_of(cells_[c])) std::erase(at_[v], c);
  cells_[c].fill(-1);
  quality_[c] = 1;
}

void CellMesh::move(int v, const Vec3& to) {
  changes_.push_back({-1, v, {}, points_[v]});
  points_[v] = to;
  for (const int c : at_[v]) quality_[c] = quality_with(cells_[c]);
}

void CellMesh::undo(std::size_t state) {
  while (changes_.size() > state) {
    const Change change = changes_.back();
    if (change.vertex >= 0) {
      move(change.vertex, change.from);
    } else if (change.corners[0] < 0) {
      remove(change.cell);
    } else {
      cells_[change.cell] = change.corners;
      quality_[change.cell] = quality_with(change.corners);
      for (const int v : nodes_of(change.corners)) at_[v].push_back(change.cell);
    }
    changes_.resize(changes_.size() - (change.vertex >= 0 || change.corners[0] < 0 ? 2 : 1));
  }
}

std::vector<int> CellMesh::cells_with(std::initializer_list<int> corners) const {
  std::vector<int> found;
  for (const int c : at_[*corners.begin()])
    if (std::ranges::all_of(corners, [&](int v) { return has_corner(cells_[c], v); })) found.push_back(c);
  return found;
}

double CellMesh::least(const std::vector<int>& cells) const {
  double least = 1;
  for (const int c : cells) least = std::min(least, quality_[c]);
  return least;
}

bool CellMesh::replace(const std::vector<int>& old, const std::vector<Cell>& by, double gain) {
  const double before = least(old) + gain;
  for (const Cell& cell : by)
    if (!(quality_with(cell) > before)) return false;
  for (const int c : old) remove(c);
  for (const Cell& cell : by) add(cell);
  return true;
}

std::vector<int> CellMesh::ring(int a, int b, bool& is_open) const {
  std::vector<std::array<int, 2>> steps;
  for (const int c : cells_with({a, b})) {
    const Cell& cell = cells_[c];
    if (cell[4] >= 0) return {};
    for (const Quad& side : cell_tables::kTetSides) {
      std::array<int, 3> corners = {cell[side[0]], cell[side[1]], cell[side[2]]};
      if (std::ranges::find(corners, a) != corners.end()) continue;
      std::ranges::rotate(corners, std::ranges::find(corners, b));
      steps.push_back({corners[1], corners[2]});
    }
  }
  if (steps.empty()) return {};
  std::vector<int> around = {steps[0][0]};
  const auto next = [&](int v) { return std::ranges::find(steps, v, [](const auto& s) { return s[0]; }); };
  // An open ring begins at the vertex that no step reaches.
  for (const auto& [from, to] : steps)
    if (std::ranges::none_of(steps, [&, f = from](const auto& s) { return s[1] == f; })) around[0] = from;
  for (auto step = next(around[0]); step != steps.end() && (*step)[1] != around[0]; step = next((*step)[1])) {
    around.push_back((*step)[1]);
    if (around.size() > steps.size() + 1) return {};
  }
  is_open = around.size() == steps.size() + 1;
  return is_open || around.size() == steps.size() ? around : std::vector<int>();
}

}  // namespace delquad
