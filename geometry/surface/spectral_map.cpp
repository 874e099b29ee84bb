// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/SparseCholesky>

#include <cassert>

#include "geometry/surface/conformal_maps.h"
#include "geometry/surface/laplacian.h"

namespace delquad {

namespace {

/// Returns the Dirichlet energy of both coordinates minus the area, as a quadratic form over (x, y) of each
/// vertex.
Eigen::SparseMatrix<double> conformal_energy(const Chart& chart) {
  std::vector<Eigen::Triplet<double>> entries;
  const auto cotangents = corner_cotangents(chart);
  for (std::size_t t = 0; t < chart.triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const int i = chart.triangles[t][(k + 1) % 3], j = chart.triangles[t][(k + 2) % 3];
      const double w = cotangents[t][k] / 2;
      for (int c = 0; c < 2; ++c) {
        entries.emplace_back(2 * i + c, 2 * i + c, w);
        entries.emplace_back(2 * j + c, 2 * j + c, w);
        entries.emplace_back(2 * i + c, 2 * j + c, -w);
        entries.emplace_back(2 * j + c, 2 * i + c, -w);
      }
    }
  }
  for (const auto& loop : chart.loops) {
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const int i = loop[k], j = loop[(k + 1) % loop.size()];
      entries.emplace_back(2 * i, 2 * j + 1, -0.5);
      entries.emplace_back(2 * j + 1, 2 * i, -0.5);
      entries.emplace_back(2 * j, 2 * i + 1, 0.5);
      entries.emplace_back(2 * i + 1, 2 * j, 0.5);
    }
  }
  const auto n = static_cast<Eigen::Index>(2 * chart.points.size());
  // Constants cost nothing. Weights are about 1, so the shift is far below differences between maps.
  constexpr double kShift = 1e-9;
  for (int i = 0; i < n; ++i) entries.emplace_back(i, i, kShift);
  Eigen::SparseMatrix<double> energy(n, n);
  energy.setFromTriplets(entries.begin(), entries.end());
  return energy;
}

}  // namespace

std::vector<Vec2> spectral_map(const Chart& chart) {
  assert(!chart.loops.empty());
  constexpr int kMaxIterations = 25;
  constexpr double kSettled = 1e-7;  // relative change of the boundary
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors(conformal_energy(chart));
  const int n = static_cast<int>(chart.points.size()), n_boundary = chart.n_boundary;
  Eigen::VectorXd z(2 * n), load(2 * n), last = Eigen::VectorXd::Zero(2 * n);
  for (int v = 0; v < n; ++v) {
    const Vec3 p = chart.points[v] - chart.points[0];
    z[2 * v] = dot(p, Vec3{1, 0.31, 0.17});
    z[2 * v + 1] = dot(p, Vec3{-0.23, 1, 0.61});
  }
  for (int i = 0; i < kMaxIterations; ++i) {
    double mean[2] = {0, 0};
    for (int v = 0; v < n_boundary; ++v)
      for (int c = 0; c < 2; ++c) mean[c] += z[2 * v + c] / n_boundary;
    load.setZero();
    for (int v = 0; v < n_boundary; ++v)
      for (int c = 0; c < 2; ++c) load[2 * v + c] = z[2 * v + c] - mean[c];
    load /= load.norm();
    if ((load - last).norm() < kSettled) break;
    last = load;
    z = factors.solve(load);
  }
  std::vector<Vec2> flat;
  for (int v = 0; v < n; ++v) flat.push_back({z[2 * v], z[2 * v + 1]});
  return flat;
}

}  // namespace delquad
