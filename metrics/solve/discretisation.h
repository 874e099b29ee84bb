// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/SparseCore>
#include <array>
#include <cstddef>
#include <functional>
#include <vector>

#include "base/cancel.h"
#include "base/gauss_rule.h"
#include "delquad/mesh.h"

// This header discretizes equations on a mesh. The solvers of measures use it.

namespace delquad {

/// A quadrature point on an element, with the shape functions there.
struct ElementPoint {
  double weight;                 ///< weight times its area
  Vec3 at;                       ///< place on the element
  Vec3 normal;                   ///< unit normal
  std::array<double, 4> value;   ///< value of each shape function
  std::array<Vec3, 4> gradient;  ///< gradient of each shape function, tangent to the element
};

/// Returns Gauss's rule in both directions on the bilinear quad through `corners`, in the plane or in space
/// [hughes2000, sections 3.2 and 3.8]. If its last two corners coincide, it is a linear triangle, and shape
/// functions 2 and 3 add up [hughes2000, section 3.6].
std::vector<ElementPoint> element_points(const std::array<Vec3, 4>& corners,
                                         const std::vector<GaussPoint>& rule);

/// Nodes and elements of a mesh to compute with. Nodes are the mesh's points; nodes on edges of a single
/// element are fixed.
class Discretisation {
 public:
  /// Throws InputError for inverted or degenerate elements, for no elements, and for no free nodes. The mesh
  /// must outlive it.
  explicit Discretisation(const Mesh& mesh);

  std::size_t n_nodes() const { return mesh_.points.size(); }
  std::size_t n_free() const { return n_free_; }
  const Vec3& point(std::size_t node) const { return mesh_.points[node]; }
  /// Returns the row of a free node, numbered without gaps; -1: fixed, or without element.
  int row(std::size_t node) const { return row_[node]; }
  bool is_fixed(std::size_t node) const { return fixed_[node] != 0; }
  /// Returns whether all points have the same z.
  bool is_planar() const { return planar_; }
  /// Returns the rows of each part of the mesh without fixed nodes.
  const std::vector<std::vector<int>>& floating() const { return floating_; }
  /// Returns the floating part of a node; -1: none.
  int floating_part(std::size_t node) const { return floating_part_[node]; }

  /// Calls visit(nodes, point) for all points of Gauss's rule of n x n on all elements. Triangles repeat
  /// their third node.
  template <class Visit>
  void for_each_point(int n, Visit visit) const {
    const std::vector<GaussPoint> rule = gauss_rule(n);
    const auto on = [&](const std::array<int, 4>& v) {
      check_cancelled();
      const std::array corners = {mesh_.points[v[0]], mesh_.points[v[1]], mesh_.points[v[2]],
                                  mesh_.points[v[3]]};
      for (const ElementPoint& p : element_points(corners, rule)) visit(v, p);
    };
    for (const auto& v : mesh_.triangles) on({v[0], v[1], v[2], v[2]});
    for (const auto& v : mesh_.quads) on(v);
  }

 private:
  void number_nodes();
  void find_floating();

  const Mesh& mesh_;
  bool planar_ = true;
  std::size_t n_free_ = 0;
  std::vector<char> fixed_;
  std::vector<int> row_, floating_part_;
  std::vector<std::vector<int>> floating_;
};

/// A symmetric matrix, positive definite up to a known kernel. The kernel has, for each set in `floating`,
/// the vector that is 1 on it and 0 elsewhere.
struct LinearSystem {
  Eigen::SparseMatrix<double> matrix;      ///< both triangles
  Eigen::VectorXd scale;                   ///< Jacobi's scaling D of each row, positive
  Eigen::VectorXd right;                   ///< right side, orthogonal to the kernel
  std::vector<std::vector<int>> floating;  ///< no set is empty
};

/// Residual, relative to the right side, at which conjugate gradients with Jacobi's preconditioner D^-1 stop.
/// They start at zero.
inline constexpr double kCgTolerance = 1e-8;
/// Largest relative error of an eigenvalue in condition_number().
inline constexpr double kEigenvalueTolerance = 1e-3;

/// Returns the largest eigenvalue of a symmetric operator on vectors of size n, with relative error
/// kEigenvalueTolerance. Lanczos' method with full orthogonalization [golub2013, sections 10.1 and 10.3] runs
/// until the residual of the Ritz pair is below that. `project` removes a subspace. Throws InputError if it
/// does not converge.
double largest_eigenvalue(
    Eigen::Index n, const std::function<Eigen::VectorXd(const Eigen::VectorXd&)>& apply,
    const std::function<void(Eigen::VectorXd&)>& project = [](Eigen::VectorXd&) {});

/// Returns the solution by Cholesky's factorization; the first unknown of each floating set is 0. Throws
/// InputError for an improper matrix.
Eigen::VectorXd solve_directly(const LinearSystem& system);

/// Returns the iterations of conjugate gradients to kCgTolerance. Throws InputError if they do not converge.
int cg_iterations(const LinearSystem& system);

/// Returns largest over least eigenvalue of D^-1/2 K D^-1/2 without the kernel, which governs these
/// iterations. Lanczos' method runs on it and its inverse. Throws InputError if it does not converge.
double condition_number(const LinearSystem& system);

}  // namespace delquad
