// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/surface/laplacian.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>

namespace delquad {

namespace {

/// Height of a triangle over its longest side below which cotangents are bounded.
constexpr double kFlattest = 1e-6;

}  // namespace

std::vector<std::array<double, 3>> corner_cotangents(const Chart& chart) {
  std::vector<std::array<double, 3>> cotangents;
  for (int t = 0; t < std::ssize(chart.triangles); ++t) {
    const std::array<Vec3, 3> at = corners_of(chart, t);
    Vec3 side[3];  // side[k] is opposite to vertex k
    double longest = 0;
    for (int k = 0; k < 3; ++k) {
      side[k] = at[(k + 2) % 3] - at[(k + 1) % 3];
      longest = std::max(longest, dot(side[k], side[k]));
    }
    const double twice_area =
        std::max({norm(cross(side[0], side[1])), kFlattest * longest, std::numeric_limits<double>::min()});
    auto& cot = cotangents.emplace_back();
    for (int k = 0; k < 3; ++k) cot[k] = -dot(side[(k + 1) % 3], side[(k + 2) % 3]) / twice_area;
  }
  return cotangents;
}

std::vector<double> vertex_areas(const Chart& chart) {
  std::vector<double> areas(chart.points.size(), 0.0);
  const std::vector<double> triangle = triangle_areas(chart);
  for (std::size_t t = 0; t < triangle.size(); ++t)
    for (int v : chart.triangles[t]) areas[v] += triangle[t] / 3;
  return areas;
}

struct LaplaceSolver::System {
  Eigen::SparseMatrix<double> all;  ///< L over all vertices
  std::vector<char> fixed;
  std::vector<int> unknown;  ///< unknown of each vertex; -1: fixed
  int n_unknowns = 0;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors;
};

LaplaceSolver::LaplaceSolver(const Chart& chart, std::vector<char> fixed, double shift)
    : system_(std::make_shared<System>()) {
  assert(fixed.size() == chart.points.size());
  assert(shift > 0 || std::ranges::find(fixed, 1) != fixed.end());
  System& s = *system_;
  s.fixed = std::move(fixed);
  s.unknown.assign(chart.points.size(), -1);
  for (std::size_t v = 0; v < chart.points.size(); ++v)
    if (!s.fixed[v]) s.unknown[v] = s.n_unknowns++;

  std::vector<Eigen::Triplet<double>> all, inner;
  auto add = [&](int i, int j, double w) {
    all.emplace_back(i, j, w);
    if (s.unknown[i] >= 0 && s.unknown[j] >= 0) inner.emplace_back(s.unknown[i], s.unknown[j], w);
  };
  const auto cotangents = corner_cotangents(chart);
  for (std::size_t t = 0; t < chart.triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const int i = chart.triangles[t][(k + 1) % 3], j = chart.triangles[t][(k + 2) % 3];
      const double w = cotangents[t][k] / 2;
      add(i, i, w);
      add(j, j, w);
      add(i, j, -w);
      add(j, i, -w);
    }
  }
  const int n = static_cast<int>(chart.points.size());
  s.all.resize(n, n);
  s.all.setFromTriplets(all.begin(), all.end());
  if (shift > 0) {
    const std::vector<double> areas = vertex_areas(chart);
    for (int v = 0; v < n; ++v)
      if (s.unknown[v] >= 0) inner.emplace_back(s.unknown[v], s.unknown[v], shift * areas[v]);
  }
  Eigen::SparseMatrix<double> matrix(s.n_unknowns, s.n_unknowns);
  matrix.setFromTriplets(inner.begin(), inner.end());
  s.factors.compute(matrix);
}

std::vector<double> LaplaceSolver::solve(const std::vector<double>& values,
                                         const std::vector<double>& load) const {
  assert(values.size() == system_->fixed.size() && load.size() == values.size());
  const System& s = *system_;
  std::vector<double> x(values);
  for (std::size_t v = 0; v < x.size(); ++v)
    if (!s.fixed[v]) x[v] = 0;
  const std::vector<double> known = apply(x);
  Eigen::VectorXd rhs(s.n_unknowns);
  for (std::size_t v = 0; v < x.size(); ++v)
    if (s.unknown[v] >= 0) rhs[s.unknown[v]] = load[v] - known[v];
  if (s.n_unknowns == 0) return x;
  const Eigen::VectorXd inner = s.factors.solve(rhs);
  for (std::size_t v = 0; v < x.size(); ++v)
    if (s.unknown[v] >= 0) x[v] = inner[s.unknown[v]];
  return x;
}

std::vector<double> LaplaceSolver::apply(const std::vector<double>& x) const {
  assert(x.size() == system_->fixed.size());
  std::vector<double> y(x.size());
  const auto n = static_cast<Eigen::Index>(x.size());
  Eigen::Map<Eigen::VectorXd>(y.data(), n) = system_->all * Eigen::Map<const Eigen::VectorXd>(x.data(), n);
  return y;
}

std::vector<double> fiedler_function(const Chart& chart) {
  constexpr int kIterations = 20;
  const std::vector<double> areas = vertex_areas(chart);
  const double total = std::accumulate(areas.begin(), areas.end(), 0.0);
  // A shift far below the first eigenvalue, about 10 / area, but enough for a safe factorization.
  const LaplaceSolver solver(chart, std::vector<char>(areas.size(), 0), 1e-3 / total);

  // Begins with a slanted height, which is smooth and has no symmetry.
  std::vector<double> x(areas.size()), load(areas.size());
  for (std::size_t v = 0; v < x.size(); ++v)
    x[v] = dot(chart.points[v] - chart.points[0], Vec3{1.0, 0.73, 0.41});
  auto normalise = [&] {
    double mean = 0, square = 0;
    for (std::size_t v = 0; v < x.size(); ++v) mean += areas[v] * x[v] / total;
    for (double& value : x) value -= mean;
    for (std::size_t v = 0; v < x.size(); ++v) square += areas[v] * x[v] * x[v] / total;
    if (square > 0)
      for (double& value : x) value /= std::sqrt(square);
  };
  normalise();
  for (int i = 0; i < kIterations; ++i) {
    for (std::size_t v = 0; v < x.size(); ++v) load[v] = areas[v] * x[v];
    x = solver.solve(x, load);
    normalise();
  }
  return x;
}

}  // namespace delquad
