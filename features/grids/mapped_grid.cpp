// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/grids/mapped_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/predicates.h"
#include "geometry/mesh/quad_corners.h"
#include "geometry/mesh/quad_topology.h"
#include "geometry/mesh/tri_topology.h"
#include "smoothing/optimisation/planar_tracks.h"
#include "smoothing/relocation/untangling.h"

namespace delquad {
namespace {

/// Stations on each line across a ring at which the size is asked for, and lines at most.
constexpr int kRingStations = 16;
constexpr std::size_t kMostRingLines = 64;
/// Passes of the optimization of a grid, at most, and steps in each: lines that bend where grids meet take
/// many to become smooth.
constexpr int kGridPasses = 6, kGridSteps = 200;

/// Some points of a grid, one after the other.
using Chain = std::vector<int>;

Chain reversed(Chain chain) {
  std::ranges::reverse(chain);
  return chain;
}

/// The points of a boundary from one to another.
Chain boundary_side(int n, int from, int to) {
  Chain side{from};
  do {
    side.push_back((side.back() + 1) % n);
  } while (side.back() != to);
  return side;
}

/// The loops of a boundary, each from its first point on.
std::vector<Chain> boundary_loops(const PatchBoundary& boundary) {
  std::vector<Chain> loops;
  for (const auto& [a, b] : boundary.edges) {
    if (loops.empty() || loops.back().front() == loops.back().back()) loops.push_back({a});
    loops.back().push_back(b);
  }
  return loops;
}

/// The place on the inner loop that faces the first one on the outer one; both are closed chains.
template <class Vec>
std::size_t best_shift(const std::vector<Vec>& points, const Chain& outer, const Chain& inner) {
  const std::size_t n = outer.size() - 1, step = 1 + n / kMostRingLines;
  std::size_t best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t shift = 0; shift < n; ++shift) {
    double sum = 0;
    for (std::size_t i = 0; i < n && sum < least; i += step) {
      const Vec d = points[inner[(shift + n - i) % n]] - points[outer[i]];
      sum += dot(d, d);
    }
    if (sum < least) least = sum, best = shift;
  }
  return best;
}

template <class Vec>
class GridMaker {
 public:
  GridMaker(const std::vector<Vec>& places, const std::vector<double>& layers)
      : grid_{places, {}}, layers_(layers) {}

  /// Four sides from the left to the right or from the bottom to the top, between the same corners.
  void add_block(const Chain& bottom, const Chain& right, const Chain& top, const Chain& left) {
    const std::vector<double> sb = parts(bottom), st = parts(top), tl = parts(left), tr = parts(right);
    const std::size_t n = bottom.size(), m = left.size();
    std::vector<Chain> rows{bottom};
    for (std::size_t j = 1; j + 1 < m; ++j) {
      Chain& row = rows.emplace_back(Chain{left[j]});
      for (std::size_t i = 1; i + 1 < n; ++i) {
        const double det = 1 - (st[i] - sb[i]) * (tr[j] - tl[j]);
        const double u = ((1 - tl[j]) * sb[i] + tl[j] * st[i]) / det;
        const double v = ((1 - sb[i]) * tl[j] + sb[i] * tr[j]) / det;
        const auto& p = grid_.points;
        row.push_back(add_point((1 - v) * p[bottom[i]] + v * p[top[i]] + (1 - u) * p[left[j]] +
                                u * p[right[j]] -
                                ((1 - u) * (1 - v) * p[bottom.front()] + u * (1 - v) * p[bottom.back()] +
                                 u * v * p[top.back()] + (1 - u) * v * p[top.front()])));
      }
      row.push_back(right[j]);
    }
    rows.push_back(top);
    for (std::size_t j = 0; j + 1 < m; ++j) add_row(rows[j], rows[j + 1]);
  }

  /// Sides from corner to corner.
  bool add_three_blocks(const std::array<Chain, 3>& sides) {
    std::array<int, 3> n{};
    for (const int k : {0, 1, 2}) n[k] = static_cast<int>(sides[k].size()) - 1;
    if ((n[0] + n[1] + n[2]) % 2 != 0) return false;
    // Edges of side k before the place where it is divided: as many as side k - 1 has behind its own.
    std::array<int, 3> first{};
    for (const int k : {0, 1, 2}) first[k] = (n[k] + n[(k + 1) % 3] - n[(k + 2) % 3]) / 2;
    if (std::ranges::min(first) < 1) return false;
    Vec middle = {};
    for (const int k : {0, 1, 2}) middle = middle + 1.0 / 3 * grid_.points[sides[k][first[k]]];
    const int centre = add_point(middle);
    std::array<Chain, 3> spokes;  // from the places of division
    for (const int k : {0, 1, 2}) spokes[k] = add_line(sides[k][first[k]], centre, first[(k + 1) % 3]);
    for (const int k : {0, 1, 2}) {
      const int before = (k + 2) % 3;
      const Chain along(sides[k].begin(), sides[k].begin() + first[k] + 1);
      const Chain back(sides[before].begin() + first[before], sides[before].end());
      add_block(along, spokes[k], spokes[before], reversed(back));
    }
    return true;
  }

  /// Loops as closed chains, the inner one clockwise.
  bool add_ring(const Chain& outer, const Chain& inner) {
    if (outer.size() != inner.size()) return false;
    const std::size_t n = outer.size() - 1;
    const std::size_t shift = best_shift(grid_.points, outer, inner);
    std::vector<Chain> rows(layers_.size() + 2);
    for (std::size_t i = 0; i < n; ++i) {
      const int from = outer[i], to = inner[(shift + n - i) % n];
      rows.front().push_back(from);
      for (std::size_t j = 0; j < layers_.size(); ++j)
        rows[j + 1].push_back(
            add_point((1 - layers_[j]) * grid_.points[from] + layers_[j] * grid_.points[to]));
      rows.back().push_back(to);
    }
    for (Chain& row : rows) row.push_back(row.front());
    for (std::size_t j = 0; j + 1 < rows.size(); ++j) add_row(rows[j], rows[j + 1]);
    return true;
  }

  MappedGrid<Vec> take() { return std::move(grid_); }

 private:
  int add_point(const Vec& x) {
    grid_.points.push_back(x);
    return static_cast<int>(grid_.points.size()) - 1;
  }
  Chain add_line(int from, int to, int n) {
    Chain line{from};
    for (int k = 1; k < n; ++k) {
      const double t = static_cast<double>(k) / n;
      line.push_back(add_point((1 - t) * grid_.points[from] + t * grid_.points[to]));
    }
    line.push_back(to);
    return line;
  }
  void add_row(const Chain& below, const Chain& above) {
    for (std::size_t i = 0; i + 1 < below.size(); ++i)
      grid_.quads.push_back({below[i], below[i + 1], above[i + 1], above[i]});
  }
  /// Lengths from a chain's beginning, as parts of the whole.
  std::vector<double> parts(const Chain& chain) const {
    std::vector<double> parts{0};
    for (std::size_t i = 1; i < chain.size(); ++i)
      parts.push_back(parts.back() + norm(grid_.points[chain[i]] - grid_.points[chain[i - 1]]));
    const double whole = parts.back() > 0 ? parts.back() : 1;
    for (double& part : parts) part /= whole;
    return parts;
  }

  MappedGrid<Vec> grid_;
  const std::vector<double>& layers_;
};

}  // namespace

template <class Vec>
std::optional<MappedGrid<Vec>> interpolated_grid(const PatchBoundary& boundary,
                                                 const std::vector<Vec>& places,
                                                 const std::vector<int>& corners,
                                                 const std::vector<double>& layers) {
  GridMaker<Vec> maker(places, layers);
  const int n = static_cast<int>(boundary.points.size());
  const auto side = [&](std::size_t k) {
    return boundary_side(n, corners[k], corners[(k + 1) % corners.size()]);
  };
  if (corners.empty()) {
    const std::vector<Chain> loops = boundary_loops(boundary);
    if (loops.size() != 2 || !maker.add_ring(loops[0], loops[1])) return std::nullopt;
  } else if (corners.size() == 3) {
    if (!maker.add_three_blocks({side(0), side(1), side(2)})) return std::nullopt;
  } else {
    const Chain bottom = side(0), right = side(1), top = reversed(side(2)), left = reversed(side(3));
    if (bottom.size() != top.size() || left.size() != right.size()) return std::nullopt;
    maker.add_block(bottom, right, top, left);
  }
  return maker.take();
}

template std::optional<MappedGrid<Vec2>> interpolated_grid(const PatchBoundary&, const std::vector<Vec2>&,
                                                           const std::vector<int>&,
                                                           const std::vector<double>&);
template std::optional<MappedGrid<Vec3>> interpolated_grid(const PatchBoundary&, const std::vector<Vec3>&,
                                                           const std::vector<int>&,
                                                           const std::vector<double>&);

std::vector<double> ring_layers(const PatchBoundary& boundary, const ParametricSize& size) {
  const std::vector<Chain> loops = boundary_loops(boundary);
  if (loops.size() != 2 || loops[0].size() != loops[1].size()) return {};
  const std::size_t n = loops[0].size() - 1, step = 1 + n / kMostRingLines;
  const std::size_t shift = best_shift(boundary.points, loops[0], loops[1]);
  // Edges up to the end of each station.
  std::vector<double> edges(kRingStations + 1, 0);
  double widest = 0, narrowest = std::numeric_limits<double>::infinity();
  int lines = 0, hint = -1;
  for (std::size_t i = 0; i < n; i += step, ++lines) {
    const Vec2 a = boundary.points[loops[0][i]], b = boundary.points[loops[1][(shift + n - i) % n]];
    double width = 0;
    for (int k = 0; k < kRingStations; ++k) {
      const double t = (k + 0.5) / kRingStations;
      const double part = norm(b - a) / kRingStations / size.at((1 - t) * a + t * b, hint);
      edges[k + 1] += part;
      width += part;
    }
    widest = std::max(widest, width);
    narrowest = std::min(narrowest, width);
  }
  for (int k = 0; k < kRingStations; ++k) edges[k + 1] = edges[k] + edges[k + 1] / lines;
  int wanted = std::max(1, static_cast<int>(std::lround(edges.back())));
  // More rows where edges across were longer than is asked for, and do not get shorter than that.
  while (widest > QuadLimits{}.longest * wanted && narrowest >= QuadLimits{}.shortest * (wanted + 1))
    ++wanted;
  std::vector<double> layers;
  for (int j = 1, k = 0; j < wanted; ++j) {
    const double target = edges.back() * j / wanted;
    while (k + 1 < kRingStations && edges[k + 1] < target) ++k;
    layers.push_back((k + (target - edges[k]) / (edges[k + 1] - edges[k])) / kRingStations);
  }
  return layers;
}

bool are_convex(const std::vector<Vec2>& points, const std::vector<std::array<int, 4>>& quads, Vec2* at) {
  for (const auto& q : quads)
    for (int k = 0; k < 4; ++k)
      if (!(orient2d(points[q[k]], points[q[(k + 1) % 4]], points[q[(k + 2) % 4]]) > 0)) {
        if (at != nullptr) *at = points[q[(k + 1) % 4]];
        return false;
      }
  return true;
}

void smooth_grid(QuadPatch& grid, const CrossField& cross, const ParametricSize& size) {
  if (!are_convex(grid.points, grid.quads)) {
    QuadTopology topology(grid);
    std::vector<int> inside;
    for (int v = grid.n_boundary; v < topology.vertex_slots(); ++v) inside.push_back(v);
    untangle(topology, inside);
    for (const int v : inside) grid.points[v] = topology.point(v);
  }
  const std::vector<Vec2> nodes(grid.points.begin(), grid.points.begin() + grid.n_boundary);
  std::vector<int> point_node(nodes.size());
  std::iota(point_node.begin(), point_node.end(), 0);
  PlanarTracks tracks(nodes, {}, {{&grid, point_node, &cross}}, size);
  std::vector<Vec2> points = tracks.points();
  OptimisationOptions options;
  options.passes = kGridPasses;
  options.iterations = kGridSteps;
  options.alignment = 0;  // the sides have told where the quads point
  optimise_on_tracks(points, tracks.quads(), tracks, options);
  tracks.store(points);
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
  link_neighbours(mesh.triangles);
  return mesh;
}

}  // namespace delquad
