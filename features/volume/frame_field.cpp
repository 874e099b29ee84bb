// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/volume/hexahedra_steps.h"

#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_cell_base_with_info_3.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>

#include <algorithm>
#include <cmath>

#include "base/sort_unique.h"

namespace delquad {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Vertex = CGAL::Triangulation_vertex_base_with_info_3<int, Kernel>;
using Tetrahedron = CGAL::Triangulation_cell_base_with_info_3<int, Kernel>;
using Delaunay =
    CGAL::Delaunay_triangulation_3<Kernel, CGAL::Triangulation_data_structure_3<Vertex, Tetrahedron>>;
using Axes = std::array<Vec3, 3>;

/// Coefficients of the monomials of degree four.
constexpr int kTerms = 15;
using Quartic = Eigen::Array<double, kTerms, 1>;
using Exponents = std::array<int, 3>;
constexpr Exponents kExponents[kTerms] = {{4, 0, 0}, {0, 4, 0}, {0, 0, 4}, {3, 1, 0}, {3, 0, 1},
                                          {1, 3, 0}, {0, 3, 1}, {1, 0, 3}, {0, 1, 3}, {2, 2, 0},
                                          {2, 0, 2}, {0, 2, 2}, {2, 1, 1}, {1, 2, 1}, {1, 1, 2}};
constexpr int kMultinomial[kTerms] = {1, 1, 1, 4, 4, 4, 4, 4, 4, 6, 6, 6, 12, 12, 12};

using Powers = std::array<std::array<double, 5>, 3>;

Powers powers_of(const Vec3& a) {
  Powers p;
  for (int k = 0; k < 3; ++k) {
    p[k][0] = 1;
    for (int i = 1; i < 5; ++i) p[k][i] = p[k][i - 1] * coordinate(a, k);
  }
  return p;
}

double monomial(double factor, const Powers& x, const Exponents& e) {
  return factor * x[0][e[0]] * x[1][e[1]] * x[2][e[2]];
}

Quartic quartic_of(const Axes& axes) {
  Quartic p = Quartic::Zero();
  for (const Vec3& a : axes) {
    const Powers x = powers_of(a);
    for (int m = 0; m < kTerms; ++m) p[m] += monomial(kMultinomial[m], x, kExponents[m]);
  }
  return p;
}

/// Returns the sum of a quartic over axes.
double value(const Quartic& p, const Axes& axes) {
  double sum = 0;
  for (const Vec3& a : axes) {
    const Powers x = powers_of(a);
    for (int m = 0; m < kTerms; ++m) sum += monomial(p[m], x, kExponents[m]);
  }
  return sum;
}

Vec3 gradient(const Quartic& p, const Vec3& at) {
  const Powers x = powers_of(at);
  std::array<double, 3> g = {};
  for (int m = 0; m < kTerms; ++m)
    for (int k = 0; k < 3; ++k)
      if (Exponents e = kExponents[m]; e[k]-- > 0) g[k] += monomial(p[m] * (e[k] + 1), x, e);
  return {g[0], g[1], g[2]};
}

/// Returns the size along a direction.
double along(const FrameValues& values, const Vec3& a) {
  const auto m = values.tail<6>();
  return m[0] * a.x * a.x + m[1] * a.y * a.y + m[2] * a.z * a.z +
         2 * (m[3] * a.x * a.y + m[4] * a.x * a.z + m[5] * a.y * a.z);
}

void add_square(FrameValues& values, double factor, const Vec3& a) {
  auto m = values.tail<6>();
  m[0] += factor * a.x * a.x, m[1] += factor * a.y * a.y, m[2] += factor * a.z * a.z;
  m[3] += factor * a.x * a.y, m[4] += factor * a.x * a.z, m[5] += factor * a.y * a.z;
}

/// Returns the rotation nearest to the matrix of three rows, by Newton's iteration; the guess if it fails.
Axes nearest_rotation(Axes x, const Axes& guess) {
  for (int i = 0; i < 20; ++i) {
    Axes c = {cross(x[1], x[2]), cross(x[2], x[0]), cross(x[0], x[1])};
    const double det = dot(x[0], c[0]);
    if (!(det > 1e-12)) return guess;
    double change = 0;
    for (int k = 0; k < 3; ++k) {
      const Vec3 next = 0.5 * (x[k] + (1 / det) * c[k]);
      change = std::max(change, norm(next - x[k]));
      x[k] = next;
    }
    if (change < 1e-8) break;
  }
  return x;
}

/// Maximizes the sum of p over the axes: the polar part of the gradients does not lower it, as p is convex.
Axes project(const Quartic& p, Axes axes) {
  for (int i = 0; i < 30; ++i) {
    Axes gradients;
    for (int k = 0; k < 3; ++k) gradients[k] = 0.25 * gradient(p, axes[k]) + 0.02 * axes[k];
    const Axes next = nearest_rotation(gradients, axes);
    const double change =
        std::max({norm(next[0] - axes[0]), norm(next[1] - axes[1]), norm(next[2] - axes[2])});
    axes = next;
    if (change < 2e-3) break;
  }
  return axes;
}

/// Side of a tetrahedron of the background, in sizes of the skin.
constexpr double kSpacing = 1.6;
/// Most points of the background along its grid.
constexpr double kMostGrid = 3e5;
/// Sine of the diagonals of a quad below which it tells no directions.
constexpr double kFlat = 1e-6;
/// Least size, in the median at the skin.
constexpr double kLeastSize = 0.02;
constexpr int kLinearSweeps = 60, kProjectedSweeps = 12;

/// Returns a number in [-0.5, 0.5) that depends on i alone.
double scatter(unsigned i) {
  i = (i ^ 61u) ^ (i >> 16);
  i *= 9u;
  i ^= i >> 4;
  i *= 0x27d4eb2du;
  i ^= i >> 15;
  return i / 4294967296.0 - 0.5;
}

}  // namespace

FrameField::FrameField(const Skin& skin)
    : skin_(skin), n_skin_(static_cast<int>(skin.body().points.size())), points_(skin.body().points) {
  fix_skin();
  make_cells();
  diffuse();
}

/// Sets frames and known sizes at the skin.
void FrameField::fix_skin() {
  frames_.resize(n_skin_);
  known_.assign(n_skin_, {});
  values_.assign(n_skin_, FrameValues::Zero());
  std::vector<Axes> first(n_skin_, {Vec3{1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
  for (const Quad& q : skin_.body().quads) {
    const Vec3 d = direction_of(points_[q[2]] - points_[q[0]]),
               e = direction_of(points_[q[3]] - points_[q[1]]);
    if (norm(cross(d, e)) < kFlat) continue;
    const Vec3 u = direction_of(d - e), n = direction_of(cross(d, e));
    const Axes axes = {u, cross(n, u), n};
    const Quartic p = quartic_of(axes);
    for (const int v : q) values_[v].head<kTerms>() += p, first[v] = axes;
  }
  std::vector<std::array<double, 6>> sums(n_skin_);
  for (int v = 0; v < n_skin_; ++v) frames_[v].axes = project(values_[v].head<kTerms>(), first[v]);
  for (const Quad& q : skin_.body().quads)
    for (int k = 0; k < 4; ++k)
      for (const auto& [v, w] : {std::pair(q[k], q[(k + 1) % 4]), {q[(k + 1) % 4], q[k]}}) {
        const Vec3 e = points_[w] - points_[v];
        std::array<double, 3> parts;
        for (int i = 0; i < 3; ++i) parts[i] = std::abs(dot(e, frames_[v].axes[i]));
        const auto axis = std::ranges::max_element(parts) - parts.begin();
        if (parts[axis] < 0.75 * norm(e)) continue;
        sums[v][axis] += norm(e), sums[v][axis + 3] += 1;
      }
  for (int v = 0; v < n_skin_; ++v) {
    double mean = 0, count = 0;
    for (int k = 0; k < 3; ++k) {
      if (sums[v][k + 3] > 0) known_[v][k] = sums[v][k] / sums[v][k + 3];
      mean += sums[v][k], count += sums[v][k + 3];
    }
    for (int k = 0; k < 3; ++k)
      add_square(values_[v], known_[v][k] > 0 ? known_[v][k] : mean / std::max(count, 1.0),
                 frames_[v].axes[k]);
    values_[v].head<kTerms>() = quartic_of(frames_[v].axes);
  }
}

void FrameField::make_cells() {
  std::vector<double> sizes;
  for (int v = 0; v < n_skin_; ++v)
    sizes.push_back((values_[v][kTerms] + values_[v][kTerms + 1] + values_[v][kTerms + 2]) / 3);
  std::ranges::nth_element(sizes, sizes.begin() + n_skin_ / 2);
  usual_size_ = sizes[n_skin_ / 2];
  const Box<Vec3> box = Box<Vec3>::around(std::span<const Vec3>(points_));
  const Vec3 extent = box.size();
  const double step = std::max(kSpacing * usual_size_, std::cbrt(extent.x * extent.y * extent.z / kMostGrid));
  unsigned counter = 0;
  for (double x = box.low.x + 0.5 * step; x < box.high.x; x += step)
    for (double y = box.low.y + 0.5 * step; y < box.high.y; y += step)
      for (double z = box.low.z + 0.5 * step; z < box.high.z; z += step) {
        const double dx = scatter(counter++), dy = scatter(counter++), dz = scatter(counter++);
        const Vec3 at = Vec3{x, y, z} + (0.2 * step) * Vec3{dx, dy, dz};
        if (skin_.distance(at, 0.6 * step) <= 0.6 * step || !skin_.contains(at)) continue;
        points_.push_back(at);
      }

  std::vector<std::pair<Kernel::Point_3, int>> nodes;
  for (const Vec3& p : points_)
    nodes.emplace_back(Kernel::Point_3(p.x, p.y, p.z), static_cast<int>(nodes.size()));
  Delaunay delaunay(nodes.begin(), nodes.end());
  for (const auto cell : delaunay.all_cell_handles()) cell->info() = -1;
  cell_of_.assign(n_skin_, -1);
  for (const auto cell : delaunay.finite_cell_handles()) {
    cell->info() = static_cast<int>(cells_.size());
    auto& corners = cells_.emplace_back();
    for (int k = 0; k < 4; ++k) {
      corners[k] = cell->vertex(k)->info();
      if (corners[k] < n_skin_) cell_of_[corners[k]] = cell->info();
    }
  }
  for (const auto cell : delaunay.finite_cell_handles()) {
    auto& neighbours = neighbours_.emplace_back();
    for (int k = 0; k < 4; ++k) neighbours[k] = cell->neighbor(k)->info();
  }
  beside_.resize(points_.size());
  for (const auto& c : cells_) {
    if (!skin_.contains(middle_of(points_, c))) continue;
    for (const int v : c)
      for (const int w : c)
        if (const Vec3 e = points_[w] - points_[v]; v != w)
          beside_[v].emplace_back(w, 1 / std::max(dot(e, e), 1e-300));
  }
  for (auto& list : beside_) sort_unique(list);
}

void FrameField::diffuse() {
  const int n = static_cast<int>(points_.size());
  FrameValues mean = FrameValues::Zero();
  for (int v = 0; v < n_skin_; ++v) mean += values_[v] / n_skin_;
  values_.resize(n, mean);
  const auto average = [&](int v) {
    FrameValues sum = FrameValues::Zero();
    double total = 0;
    for (const auto& [w, weight] : beside_[v]) sum += weight * values_[w], total += weight;
    return total == 0 ? values_[v] : FrameValues(sum / total);
  };
  for (int sweep = 0; sweep < kLinearSweeps; ++sweep)
    for (int v = 0; v < n; ++v) {
      const FrameValues next = average(v);
      values_[v].tail<6>() = next.tail<6>();
      if (v >= n_skin_) values_[v] = next;
      for (int k = 0; k < 3 && v < n_skin_; ++k)
        if (known_[v][k] > 0)
          add_square(values_[v], known_[v][k] - along(values_[v], frames_[v].axes[k]), frames_[v].axes[k]);
    }
  frames_.resize(n);
  for (int sweep = 0; sweep < kProjectedSweeps; ++sweep)
    for (int v = n_skin_; v < n; ++v) {
      const Quartic p = (sweep == 0 ? values_[v] : average(v)).head<kTerms>();
      Axes best = frames_[sweep == 0 ? 0 : v].axes;
      if (sweep == 0)
        for (const auto& [w, weight] : beside_[v])
          if (w < v && value(p, frames_[w].axes) > value(p, best)) best = frames_[w].axes;
      frames_[v].axes = project(p, best);
      values_[v].head<kTerms>() = quartic_of(frames_[v].axes);
    }
  for (int v = 0; v < n; ++v) set_sizes(frames_[v], values_[v]);
}

void FrameField::set_sizes(Frame& frame, const FrameValues& values) const {
  for (int k = 0; k < 3; ++k)
    frame.sizes[k] = std::max(kLeastSize * usual_size_, along(values, frame.axes[k]));
}

Frame FrameField::at(const Vec3& x, const Frame& guess, int& cell) const {
  std::array<double, 4> w{};
  if (cell < 0) return guess;
  for (int step = 0; step < 1000; ++step) {
    const auto& c = cells_[cell];
    const Vec3 &a = points_[c[0]], &b = points_[c[1]], &d = points_[c[2]], &e = points_[c[3]];
    const double whole = dot(b - a, cross(d - a, e - a));
    w = {dot(b - x, cross(d - x, e - x)), -dot(a - x, cross(d - x, e - x)), dot(a - x, cross(b - x, e - x)),
         -dot(a - x, cross(b - x, d - x))};
    int worst = 0;
    for (int k = 0; k < 4; ++k) {
      w[k] = whole > 0 ? w[k] / whole : 0.25;
      if (w[k] < w[worst]) worst = k;
    }
    if (!(w[worst] < -1e-9) || step == 999) break;
    cell = neighbours_[cell][worst];
    if (cell < 0) return guess;
  }
  FrameValues values = FrameValues::Zero();
  for (int k = 0; k < 4; ++k) values += std::clamp(w[k], 0.0, 1.0) * values_[cells_[cell][k]];
  Frame frame{project(values.head<kTerms>(), guess.axes), {}};
  set_sizes(frame, values);
  return frame;
}

}  // namespace delquad
