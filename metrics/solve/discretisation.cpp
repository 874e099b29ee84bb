// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrics/solve/discretisation.h"

#include <Eigen/Eigenvalues>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <random>
#include <utility>

#include "base/disjoint_sets.h"
#include "base/located.h"
#include "delquad/error.h"
#include "geometry/mesh/half_edges.h"
#include "metrics/shape.h"

namespace delquad {

namespace {

/// Refuses elements whose map from the square or triangle is not one to one, or not invertible somewhere.
void check_elements(const Mesh& mesh) {
  const ElementSides sides(mesh);
  std::size_t quads = 0, triangles = 0;
  for (std::size_t q = 0; q < mesh.quads.size(); ++q)
    quads += quad_shape(mesh, static_cast<int>(q), sides).scaled_jacobian > 0 ? 0 : 1;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    triangles += triangle_shape(mesh, static_cast<int>(t), sides).scaled_jacobian > 0 ? 0 : 1;
  if (quads + triangles == 0) return;
  refuse("{} of {} quads and {} of {} triangles are inverted or degenerate", quads, mesh.quads.size(),
         triangles, mesh.triangles.size());
}

/// Returns, for each point, a representative point of its part of the mesh.
std::vector<int> parts_of(const Mesh& mesh) {
  DisjointSets parts(mesh.points.size());
  for_each_element(mesh, [&](int, const auto& v) {
    for (const int i : v) parts.join(v[0], i);
  });
  return parts.roots();
}

ElementPoint point_of(const std::array<Vec3, 4>& corners, const GaussPoint& r, const GaussPoint& s) {
  constexpr std::array<std::array<int, 2>, 4> kCorners = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
  ElementPoint p{0, {}, {}, {}, {}};
  std::array<double, 4> by_r, by_s;
  Vec3 along_r, along_s;
  for (std::size_t k = 0; k < 4; ++k) {
    const auto [i, j] = kCorners[k];
    const double u = i == 1 ? r.at : 1 - r.at, v = j == 1 ? s.at : 1 - s.at;
    p.value[k] = u * v;
    by_r[k] = (2 * i - 1) * v;
    by_s[k] = (2 * j - 1) * u;
    p.at = p.at + p.value[k] * corners[k];
    along_r = along_r + by_r[k] * corners[k];
    along_s = along_s + by_s[k] * corners[k];
  }
  const Vec3 area = cross(along_r, along_s);
  const double density = norm(area);
  p.weight = r.weight * s.weight * density;
  p.normal = (1 / density) * area;
  // Dual basis of the tangents.
  const Vec3 dual_r = (1 / density) * cross(along_s, p.normal),
             dual_s = (1 / density) * cross(p.normal, along_r);
  for (std::size_t k = 0; k < 4; ++k) p.gradient[k] = by_r[k] * dual_r + by_s[k] * dual_s;
  return p;
}

}  // namespace

Discretisation::Discretisation(const Mesh& mesh)
    : mesh_(mesh),
      fixed_(mesh.points.size(), 0),
      row_(mesh.points.size(), -1),
      floating_part_(mesh.points.size(), -1) {
  if (mesh.triangles.empty() && mesh.quads.empty())
    throw InputError("there are no elements to compute with: expected triangles or quads");
  check_elements(mesh);
  for (const Vec3& p : mesh.points) planar_ = planar_ && p.z == mesh.points[0].z;
  number_nodes();
  if (n_free_ == 0)
    throw InputError("all nodes are on the boundary, so nothing is unknown: expected a finer mesh");
  find_floating();
}

void Discretisation::number_nodes() {
  const std::vector<HalfEdge> sides = sorted_half_edges(mesh_);
  for_each_edge(sides, [&](std::span<const HalfEdge> edge) {
    if (edge.size() == 1) fixed_[edge[0].lo] = fixed_[edge[0].hi] = 1;
  });
  std::vector<char> used(n_nodes(), 0);
  for_each_element(mesh_, [&](int, const auto& v) {
    for (const int i : v) used[i] = 1;
  });
  for (std::size_t i = 0; i < n_nodes(); ++i)
    if (used[i] && !fixed_[i]) row_[i] = static_cast<int>(n_free_++);
}

void Discretisation::find_floating() {
  const std::vector<int> part = parts_of(mesh_);
  std::vector<char> held(n_nodes(), 0);
  for (std::size_t i = 0; i < n_nodes(); ++i)
    if (fixed_[i]) held[part[i]] = 1;
  std::vector<int> number(n_nodes(), -1);
  for (std::size_t i = 0; i < n_nodes(); ++i) {
    if (row_[i] < 0 || held[part[i]]) continue;
    int& k = number[part[i]];
    if (k < 0) {
      k = static_cast<int>(floating_.size());
      floating_.emplace_back();
    }
    floating_[k].push_back(row_[i]);
    floating_part_[i] = k;
  }
}

std::vector<ElementPoint> element_points(const std::array<Vec3, 4>& corners,
                                         const std::vector<GaussPoint>& rule) {
  std::vector<ElementPoint> points;
  for (const GaussPoint& s : rule)
    for (const GaussPoint& r : rule) points.push_back(point_of(corners, r, s));
  return points;
}

namespace {

using Matrix = Eigen::SparseMatrix<double>;
using Vector = Eigen::VectorXd;

/// Factors of a system, with one unknown of each floating set pinned to remove the kernel.
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

/// Removes from v its components along vectors with disjoint supports.
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
  std::mt19937_64 random(1);  // any seed will do, if it is fixed
  Vector v(n);
  for (Eigen::Index i = 0; i < n; ++i) v[i] = std::ldexp(static_cast<double>(random() >> 11), -53) - 0.5;
  return v;
}

/// Tridiagonal matrices of growing size, whose eigenvalues approach an operator's.
struct Tridiagonal {
  std::vector<double> diagonal, beside;

  /// Returns the largest eigenvalue, and a bound of its error.
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
  refuse("the largest eigenvalue has not reached the accuracy {} after {} steps of Lanczos' method",
         kEigenvalueTolerance, kMost);
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
      refuse("conjugate gradients did not reach a residual of {} in {} iterations", kCgTolerance, steps);
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
