#include "metrics/solve/linear_system.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <functional>
#include <random>
#include <utility>

#include "base/cancel.h"
#include "delquad/error.h"

namespace delquad {
namespace {

using Matrix = Eigen::SparseMatrix<double>;
using Vector = Eigen::VectorXd;

/// The kernel taken away by pinning an unknown of each floating set.
class Factorisation {
 public:
  explicit Factorisation(const LinearSystem& system) {
    std::vector<char> is_pin(static_cast<std::size_t>(system.matrix.rows()), 0);
    assert(std::ranges::none_of(system.floating, [](const auto& set) { return set.empty(); }));
    for (const auto& set : system.floating) pins_.push_back(set.front());
    for (const int pin : pins_) is_pin[static_cast<std::size_t>(pin)] = 1;
    Matrix pinned = system.matrix;
    pinned.prune([&](Eigen::Index i, Eigen::Index j, double) {
      return i == j || !(is_pin[static_cast<std::size_t>(i)] || is_pin[static_cast<std::size_t>(j)]);
    });
    factors_.compute(pinned);
    if (factors_.info() != Eigen::Success || !(factors_.vectorD().minCoeff() > 0))
      throw InputError("the stiffness matrix is not positive definite in floating point");
  }
  Vector solve(Vector right) const {
    for (const int pin : pins_) right[pin] = 0;
    return factors_.solve(right);
  }

 private:
  std::vector<int> pins_;
  Eigen::SimplicialLDLT<Matrix> factors_;
};

/// Parts v orthogonally from vectors with separate supports.
void remove_parts(const std::vector<std::vector<int>>& sets, const Vector& weights, Vector& v) {
  for (const auto& set : sets) {
    double part = 0, length2 = 0;
    for (const int i : set) {
      part += weights[i] * v[i];
      length2 += weights[i] * weights[i];
    }
    for (const int i : set) v[i] -= part / length2 * weights[i];
  }
}

Vector start_vector(Eigen::Index n) {
  std::mt19937_64 random(1);  // any will do, as long as it stays
  Vector v(n);
  for (Eigen::Index i = 0; i < n; ++i) v[i] = std::ldexp(static_cast<double>(random() >> 11), -53) - 0.5;
  return v;
}

/// Tridiagonal matrices of growing size, whose eigenvalues approach those of an operator.
struct Tridiagonal {
  std::vector<double> diagonal, beside;

  /// The largest eigenvalue, and by how much at most it is none of the operator.
  std::pair<double, double> largest() const {
    const auto n = static_cast<Eigen::Index>(diagonal.size());
    const Eigen::Map<const Vector> d(diagonal.data(), n), b(beside.data(), n - 1);
    Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
    solver.computeFromTridiagonal(d, b);
    return {solver.eigenvalues()[n - 1], std::abs(beside.back() * solver.eigenvectors()(n - 1, n - 1))};
  }
};

}  // namespace

double largest_eigenvalue(Eigen::Index n, const std::function<Vector(const Vector&)>& apply,
                          const std::function<void(Vector&)>& project) {
  constexpr int kMost = 400;
  constexpr double kNothingLeft = 1e-13;  // relative to the value: the space is exhausted
  std::vector<Vector> basis;
  Tridiagonal ritz;
  Vector v = start_vector(n);
  project(v);
  v.normalize();
  for (int k = 1, next_check = 8; k <= kMost; ++k) {
    check_cancelled();
    basis.push_back(v);
    v = apply(v);
    project(v);
    ritz.diagonal.push_back(v.dot(basis.back()));
    for (int twice = 0; twice < 2; ++twice)
      for (const Vector& b : basis) v -= v.dot(b) * b;
    ritz.beside.push_back(v.norm());
    const bool exhausted = ritz.beside.back() <= kNothingLeft * std::abs(ritz.diagonal[0]);
    if (exhausted || k == std::min(next_check, kMost)) {
      next_check += next_check / 4;
      const auto [value, error] = ritz.largest();
      if (exhausted || error <= kEigenvalueTolerance * value) return value;
    }
    v /= ritz.beside.back();
  }
  throw InputError(fmt::format("the largest eigenvalue is not known to {} after {} steps of Lanczos' method",
                               kEigenvalueTolerance, kMost));
}

Vector solve_directly(const LinearSystem& system) { return Factorisation(system).solve(system.right); }

int cg_iterations(const LinearSystem& system) {
  assert(system.scale.size() == system.right.size() && (system.scale.array() > 0).all());
  constexpr int kMost = 1'000'000;
  const double goal = kCgTolerance * system.right.norm();
  Vector residual = system.right, direction = residual.cwiseQuotient(system.scale);
  double rho = residual.dot(direction);
  int steps = 0;
  for (; !(residual.norm() <= goal); ++steps) {
    check_cancelled();
    const Vector image = system.matrix * direction;
    const double along = rho / direction.dot(image);
    if (steps == kMost || !std::isfinite(along))
      throw InputError(fmt::format("conjugate gradients did not reach a residual of {} in {} iterations",
                                   kCgTolerance, steps));
    residual -= along * image;
    const Vector next = residual.cwiseQuotient(system.scale);
    const double before = std::exchange(rho, residual.dot(next));
    direction = next + rho / before * direction;
  }
  return steps;
}

double condition_number(const LinearSystem& system) {
  const Factorisation factors(system);
  const Vector root = system.scale.cwiseSqrt();
  const auto project = [&](Vector& v) { remove_parts(system.floating, root, v); };
  const auto scaled = [&](const Vector& v) -> Vector {
    return (system.matrix * v.cwiseQuotient(root)).cwiseQuotient(root);
  };
  const auto inverse = [&](const Vector& v) -> Vector {
    return factors.solve(v.cwiseProduct(root)).cwiseProduct(root);
  };
  const Eigen::Index n = root.size();
  return largest_eigenvalue(n, scaled, project) * largest_eigenvalue(n, inverse, project);
}

}  // namespace delquad
