// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/volume/fill_steps.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <utility>

#include "base/cancel.h"
#include "base/disjoint_sets.h"
#include "base/orientation.h"
#include "base/sort_unique.h"
#include "features/volume/cell_mesh.h"
#include "geometry/mesh/cell_shapes.h"
#include "geometry/mesh/find_crossings.h"
#include "geometry/mesh/half_edges.h"

namespace delquad {

namespace {

/// Pyramids below this quality are not made of two tetrahedra.
constexpr double kGoodPyramid = 0.35;

/// Turns a quad so that its diagonal from the first corner lies deeper in the void. In a plane it is the
/// shorter one, or with `other` the longer one.
Quad turned(const std::vector<Vec3>& p, Quad q, bool other) {
  int sign = orient3d(p[q[0]], p[q[1]], p[q[2]], p[q[3]]);
  if (sign == 0) sign = (norm(p[q[2]] - p[q[0]]) <= norm(p[q[3]] - p[q[1]])) == !other ? 1 : -1;
  if (sign < 0) std::rotate(q.begin(), q.begin() + 1, q.end());
  return q;
}

/// Finds the tetrahedra in the void, and adds the lost triangles of the boundary to `lost`.
std::vector<Quad> inner_tetrahedra(const Mesh& made, const std::vector<Triangle>& boundary,
                                   std::vector<int>& lost) {
  const std::vector<SolidSide> sides = sorted_sides(made);
  std::vector<Quad> walls;
  std::vector<int> at_walls;
  for (std::size_t i = 0; i < boundary.size(); ++i) {
    const auto [a, b, c] = boundary[i];
    walls.push_back(side_key(boundary[i]));
    const std::size_t n = at_walls.size();
    for (const auto& [nodes, at] : std::ranges::equal_range(sides, walls[i], {}, &SolidSide::nodes))
      if (same_turn({a, b, c, -1}, solid_at(made, at.element).side(at.side))) at_walls.push_back(at.element);
    if (at_walls.size() == n) lost.push_back(static_cast<int>(i));
  }
  std::ranges::sort(walls);
  DisjointSets parts(made.tetrahedra.size());
  for (std::size_t i = 1; i < sides.size(); ++i)
    if (sides[i].nodes == sides[i - 1].nodes && !std::ranges::binary_search(walls, sides[i].nodes))
      parts.join(sides[i - 1].side.element, sides[i].side.element);
  std::vector<char> is_inside(made.tetrahedra.size(), 0);
  for (const int c : at_walls) is_inside[parts.root(c)] = 1;
  std::vector<Quad> inside;
  for (std::size_t c = 0; c < made.tetrahedra.size(); ++c)
    if (is_inside[parts.root(static_cast<int>(c))]) inside.push_back(made.tetrahedra[c]);
  return inside;
}

/// A cell below this quality counts as flat. It is far above rounding.
constexpr double kLeastQuality = 1e-6;

class PyramidMaker {
 public:
  PyramidMaker(CellMesh& mesh, std::vector<Quad> quads) : mesh_(mesh), quads_(std::move(quads)) {
    for (const Quad& q : quads_) diagonals_.insert(std::minmax(q[0], q[2]));
  }
  /// Returns the quads that get none.
  std::vector<int> make() {
    std::vector<int> left(quads_.size()), lost;
    std::iota(left.begin(), left.end(), 0);
    std::erase_if(left, [&](int q) { return merge(quads_[q]); });
    for (const int q : left)
      if (!merge(quads_[q]) && !raise(quads_[q])) lost.push_back(q);
    return lost;
  }

 private:
  void forget(const Quad& q) { diagonals_.erase(std::minmax(q[0], q[2])); }

  /// Merges the tetrahedra on a quad if they have a common apex.
  bool merge(Quad& q) {
    std::array<int, 2> cells;
    for (int turn = 0;; ++turn) {
      const std::vector<int> one = mesh_.cells_with({q[0], q[1], q[2]}),
                             two = mesh_.cells_with({q[0], q[2], q[3]});
      if (one.size() != 1 || two.size() != 1) return false;
      cells = {one[0], two[0]};
      if (one != two) break;
      if (turn > 0) return false;
      // A tetrahedron of the four corners lies beyond the quad, whose other diagonal is deeper.
      mesh_.remove(one[0]);
      forget(q);
      std::rotate(q.begin(), q.begin() + 1, q.end());
      diagonals_.insert(std::minmax(q[0], q[2]));
    }
    int apex = -1;
    for (const int v : mesh_.cells()[cells[0]])
      if (v >= 0 && std::ranges::find(q, v) == q.end() && has_corner(mesh_.cells()[cells[1]], v)) apex = v;
    if (apex < 0) return false;
    for (const int v : q)
      if (diagonals_.contains(std::minmax(v, apex))) return false;
    const Cell pyramid = cell_of(std::array{q[0], q[3], q[2], q[1], apex});
    if (mesh_.quality_with(pyramid) < kGoodPyramid) return false;
    for (const int c : cells) mesh_.remove(c);
    mesh_.add(pyramid);
    forget(q);
    return true;
  }

  /// Splits the diagonal of a quad by a vertex, raised to where the worst cell is best.
  bool raise(const Quad& q) {
    const auto [a, b, c, d] = q;
    bool is_open = false;
    const std::vector<int> ring = mesh_.ring(a, c, is_open);
    if (!is_open) return false;
    const auto& p = mesh_.points();
    const Vec3 middle = 0.5 * (p[a] + p[c]), mean = 0.5 * (middle + 0.5 * (p[b] + p[d]));
    const Vec3 area = 0.5 * cross(p[c] - p[a], p[d] - p[b]);
    const double height = std::sqrt(norm(area) / 2);  // of a pyramid of equal edges on a square
    if (!(height > 0)) return false;
    const Vec3 inwards = (-height / norm(area)) * area;
    const int m = mesh_.add_point(middle);
    std::vector<Cell> cells = {cell_of(std::array{a, d, c, b, m})};
    const std::vector<int> old = mesh_.cells_with({a, c});
    for (const int t : old)
      for (const int end : {a, c}) {
        cells.push_back(mesh_.cells()[t]);
        std::ranges::replace(cells.back(), end, m);
      }
    double best = -2;
    Vec3 at = middle;
    for (const double t : {1.0, 0.7, 0.5, 0.35, 0.2, 0.1, 0.05, 0.02, 0.005, 0.001})
      for (const Vec3& from : {mean, middle}) {
        const Vec3 x = from + t * inwards;
        double least = 1;
        for (const Cell& cell : cells) least = std::min(least, mesh_.quality_with(cell, m, x));
        if (least > best) best = least, at = x;
      }
    mesh_.move(m, at);
    for (const int t : old) mesh_.remove(t);
    for (const Cell& cell : cells) mesh_.add(cell);
    relocate(mesh_, m);
    forget(q);
    return true;
  }

  CellMesh& mesh_;
  std::vector<Quad> quads_;
  std::set<std::pair<int, int>> diagonals_;  ///< of quads without pyramids, which no pyramid may use
};

/// Returns the face of a triangle, where quads come first and have two each.
int face_at(int triangle, std::size_t n_quads) {
  const int n = static_cast<int>(n_quads);
  return triangle < 2 * n ? triangle / 2 : triangle - n;
}

/// Returns both triangles of each quad, then the given triangles.
std::vector<Triangle> split(const std::vector<Quad>& quads, const std::vector<Triangle>& triangles) {
  std::vector<Triangle> all = halves_of(quads);
  all.insert(all.end(), triangles.begin(), triangles.end());
  return all;
}

struct Filling {
  std::vector<Vec3> points;  ///< of the body, then new ones
  std::vector<Cell> cells;   ///< hexahedra and prisms of the body too, as far as they remain
  /// Faces at which the filling fails. All are listed if TetGen fails. If the list is empty, each quad is the
  /// base of a pyramid, and all cells are positive.
  std::vector<int> lost;
};

/// Fills by the diagonals from the first corners of quads, which are turned where triangles cross.
Filling fill(const Mesh& body, VoidFaces faces, bool is_improved) {
  Filling result;
  auto& [quads, boundary, owners] = faces;
  result.lost = untangle(body.points, quads, boundary);
  if (!result.lost.empty()) return result;
  const std::vector<Triangle> triangles = split(quads, boundary);
  std::vector<Vec3> holes;
  for (std::size_t i = 0; i < n_solids(body); ++i)
    holes.push_back(middle_of(body.points, solid_at(body, i).nodes));
  const auto made = tetrahedralise(body.points, triangles, holes);
  if (!made) {
    result.lost.resize(quads.size() + boundary.size());
    std::iota(result.lost.begin(), result.lost.end(), 0);
    return result;
  }
  const std::vector<Quad> inside = inner_tetrahedra(*made, triangles, result.lost);
  for (int& face : result.lost) face = face_at(face, quads.size());
  sort_unique(result.lost);
  if (!result.lost.empty()) return result;
  std::vector<char> fixed(body.points.size(), 0);
  for_each_element(body, [&](int, const auto& face) {
    for (const int v : face) fixed[v] = 1;
  });
  CellMesh mesh(made->points, fixed);
  for (const auto& corners : inside) mesh.add(cell_of(corners));
  result.lost = PyramidMaker(mesh, quads).make();
  if (result.lost.empty()) {
    for (std::size_t i = 0; i < n_solids(body); ++i) mesh.add(cell_of(solid_at(body, i).nodes));
    if (is_improved) improve(mesh);
  }
  std::set<int> flat;
  for (std::size_t c = 0; c < mesh.cells().size(); ++c) {
    if (!mesh.is_alive(static_cast<int>(c))) continue;
    result.cells.push_back(mesh.cells()[c]);
    if (mesh.quality(static_cast<int>(c)) < kLeastQuality)
      flat.insert(mesh.cells()[c].begin(), mesh.cells()[c].end());
  }
  for (std::size_t f = 0; f < quads.size() + boundary.size(); ++f)
    if (std::ranges::count_if(faces.nodes(f), [&](int v) { return flat.contains(v); }) > 1)
      result.lost.push_back(static_cast<int>(f));
  sort_unique(result.lost);
  result.points = mesh.points();
  return result;
}

/// Fills a void. Tetrahedra come from tetrahedralise(). Two of them on a quad with a common apex become a
/// pyramid. Elsewhere a new vertex splits the diagonal of the quad and is raised. Then cells are improved, if
/// asked; blocks beside poor ones give way.
Filling fill_void(const Mesh& body, const VoidFaces& faces, bool improve) {
  Filling best;
  std::vector<char> other(faces.quads.size(), 0);
  constexpr int kAttempts = 3;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    std::vector<Quad> quads;
    for (std::size_t q = 0; q < faces.quads.size(); ++q)
      quads.push_back(turned(body.points, faces.quads[q], other[q]));
    Filling filling = fill(body, {quads, faces.triangles, {}}, improve);
    if (attempt == 0 || filling.lost.size() < best.lost.size()) best = filling;
    if (best.lost.empty()) break;
    for (const int face : filling.lost)
      if (face < static_cast<int>(other.size())) other[face] ^= 1;
  }
  return best;
}

/// Returns the cells with one of these faces, or else those that share a vertex with one.
std::vector<int> cells_at(const Mesh& body, const VoidFaces& faces, const std::vector<int>& lost) {
  std::vector<int> owners;
  std::vector<char> at(body.points.size(), 0);
  for (const int f : lost) {
    if (faces.owners[f] < 0) owners.push_back(-1 - faces.owners[f]);
    for (const int v : faces.nodes(f)) at[v] = 1;
  }
  for (std::size_t i = 0, n = owners.empty() ? n_solids(body) : 0; i < n; ++i)
    if (std::ranges::any_of(solid_at(body, i).nodes, [&](int v) { return at[v]; }))
      owners.push_back(static_cast<int>(i));
  return owners;
}

}  // namespace

std::vector<int> untangle(const std::vector<Vec3>& points, std::vector<Quad>& quads,
                          const std::vector<Triangle>& triangles, Vec3* where) {
  constexpr int kPasses = 5;  // enough for the four choices of two quads
  for (int pass = 0;; ++pass) {
    const std::vector<Triangle> all = split(quads, triangles);
    std::vector<Crossing> tangles = find_crossings(points, all, [](int, int) { return false; });
    std::vector<std::pair<Quad, int>> sorted;
    for (std::size_t i = 0; i < all.size(); ++i) sorted.emplace_back(side_key(all[i]), i);
    std::ranges::sort(sorted);
    for (std::size_t i = 1; i < sorted.size(); ++i)
      if (sorted[i].first == sorted[i - 1].first)
        tangles.push_back({sorted[i].second, sorted[i - 1].second, points[sorted[i].first[1]]});
    std::vector<int> faces;
    for (const Crossing& tangle : tangles)
      for (const int t : {tangle.first, tangle.second})
        if (pass == kPasses || t == (pass % 2 == 0 ? tangle.first : tangle.second))
          faces.push_back(face_at(t, quads.size()));
    sort_unique(faces);
    if (pass == kPasses || tangles.empty()) {
      if (where != nullptr && !tangles.empty()) *where = tangles[0].at;
      return faces;
    }
    for (const int f : faces)
      if (f < static_cast<int>(quads.size()))
        std::rotate(quads[f].begin(), quads[f].begin() + 1, quads[f].end());
  }
}

std::vector<int> fill_around(Mesh& body, bool improve) {
  drop_cells(body, {});
  for (;;) {
    check_cancelled();
    const VoidFaces faces = open_faces(body);
    if (faces.owners.empty()) return {};
    Filling filling = fill_void(body, faces, improve);
    if (filling.lost.empty()) {
      body.points = filling.points;
      body.hexahedra.clear(), body.hex_volume.clear(), body.prisms.clear(), body.prism_volume.clear();
      for (const Cell& cell : filling.cells) add_cell(body, nodes_of(cell), 0);
      return {};
    }
    const std::vector<int> cells = cells_at(body, faces, filling.lost);
    drop_cells(body, cells);
    if (!cells.empty()) continue;
    for (int& f : filling.lost) f = faces.owners[f];
    return filling.lost;
  }
}

}  // namespace delquad
