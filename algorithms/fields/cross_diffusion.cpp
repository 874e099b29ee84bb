// SPDX-License-Identifier: GPL-3.0-or-later
#include "algorithms/fields/cross_diffusion.h"

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cassert>
#include <cmath>

namespace delquad {

namespace {

/// Part of the mass of a triangle for each of its sides: a sixth of an element.
constexpr double kMass = 0.5 / 3;
/// Limit of iterations of conjugate gradients. Ordinary patches take 10 to 150, and this many cost about as
/// much as a direct solution.
constexpr int kMostIterations = 500;

using Complex = CrossDiffusion::Complex;
/// Matrix of real and imaginary parts in turn, since products of complex numbers are checked for overflow one
/// by one.
using RowMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;
using Vector = Eigen::VectorXd;

/// Solves by conjugate gradients from `start`, or directly if these do not converge. With angles near 180
/// degrees they may need as many steps as there are unknowns.
Vector solve_symmetric(const RowMatrix& matrix, const Vector& right, const Vector& start, double tolerance) {
  Eigen::ConjugateGradient<RowMatrix, Eigen::Lower | Eigen::Upper> iterative(matrix);
  iterative.setTolerance(tolerance);
  iterative.setMaxIterations(kMostIterations);
  const Vector x = iterative.solveWithGuess(right, start);
  if (iterative.info() == Eigen::Success) return x;
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> direct(matrix);
  return direct.info() == Eigen::Success ? Vector(direct.solve(right)) : x;
}

void add_entry(std::vector<Eigen::Triplet<double>>& entries, int row, int column, Complex value) {
  entries.emplace_back(2 * row, 2 * column, value.real());
  entries.emplace_back(2 * row, 2 * column + 1, -value.imag());
  entries.emplace_back(2 * row + 1, 2 * column, value.imag());
  entries.emplace_back(2 * row + 1, 2 * column + 1, value.real());
}

}  // namespace

CrossDiffusion::CrossDiffusion(const std::vector<PatchUnknowns>& patches,
                               const std::vector<double>& alignment, std::vector<Complex>& z)
    : z_(z), row_(z.size()) {
  assert(alignment.size() == z.size());
  assert(std::ranges::all_of(alignment, [](double a) { return a >= 0 || a == kGiven; }));
  assert(std::ranges::all_of(z, [](const Complex& value) { return std::abs(std::norm(value) - 1) < 1e-6; }));
  int n = 0;
  for (std::size_t i = 0; i < row_.size(); ++i) row_[i] = alignment[i] == kGiven ? -1 : n++;
  mass_.setZero(2 * n);
  fixed_.setZero(2 * n);
  stiffness_.resize(2 * n, 2 * n);
  std::vector<Eigen::Triplet<double>> entries;
  std::size_t n_triangles = 0;
  for (const PatchUnknowns& patch : patches) n_triangles += patch.tri->triangles.size();
  entries.reserve(36 * n_triangles);
  for (const PatchUnknowns& patch : patches)
    for (int t = 0; t < static_cast<int>(patch.tri->triangles.size()); ++t) add_triangle(patch, t, entries);
  for (std::size_t i = 0; i < row_.size(); ++i) {
    if (row_[i] < 0 || alignment[i] == 0) continue;
    add_entry(entries, row_[i], row_[i], alignment[i]);
    fixed_[2 * row_[i]] += alignment[i];
  }
  stiffness_.setFromTriplets(entries.begin(), entries.end());
}

void CrossDiffusion::add_triangle(const PatchUnknowns& patch, int t,
                                  std::vector<Eigen::Triplet<double>>& entries) {
  const LocalStiffness local = local_stiffness(*patch.tri, t);
  const auto unknown = [&](int k) { return patch.unknown[patch.sides.of_triangle[t][k]]; };
  for (int i = 0; i < 3; ++i) {
    const int r = row_[unknown(i)];
    if (r < 0) continue;
    mass_[2 * r] += kMass;
    mass_[2 * r + 1] += kMass;
    for (int j = 0; j < 3; ++j) {
      const Complex value = 2 * local[i][j] * std::polar(1.0, patch.phase(t, i) - patch.phase(t, j));
      if (const int c = row_[unknown(j)]; c >= 0) {
        add_entry(entries, r, c, value);
      } else {
        const Complex given = value * z_[unknown(j)];
        fixed_[2 * r] -= given.real();
        fixed_[2 * r + 1] -= given.imag();
      }
    }
  }
}

void CrossDiffusion::step(double tau, double tolerance) {
  assert(tau > 0 && tolerance > 0);
  if (mass_.size() == 0) return;
  const Vector weight = mass_ / tau;
  RowMatrix matrix = stiffness_;
  matrix.diagonal() += weight;
  Vector now(mass_.size());
  for (std::size_t i = 0; i < row_.size(); ++i) {
    if (row_[i] < 0) continue;
    now[2 * row_[i]] = z_[i].real();
    now[2 * row_[i] + 1] = z_[i].imag();
  }
  const Vector next = solve_symmetric(matrix, weight.cwiseProduct(now) + fixed_, now, tolerance);
  for (std::size_t i = 0; i < row_.size(); ++i) {
    if (row_[i] < 0) continue;
    const Complex value{next[2 * row_[i]], next[2 * row_[i] + 1]};
    if (const double length = std::abs(value); length > 0) z_[i] = value / length;
  }
}

}  // namespace delquad
