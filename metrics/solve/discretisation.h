#pragma once

#include <Eigen/SparseCore>
#include <array>
#include <cstddef>
#include <functional>
#include <vector>

#include "base/cancel.h"
#include "base/gauss_rule.h"
#include "delquad/mesh.h"

namespace delquad {

/// A point of a quadrature rule on an element, with its shape functions there.
struct ElementPoint {
  double weight;                 ///< times the area that it stands for
  Vec3 at;                       ///< on the element
  Vec3 normal;                   ///< of length 1
  std::array<double, 4> value;   ///< of each shape function
  std::array<Vec3, 4> gradient;  ///< of each, tangent to the element
};

/// Gauss's rule in both directions on the bilinear quad through `corners`, in the plane or in space
/// [hughes2000, sections 3.2 and 3.8]. With its last two corners at one place it is a linear triangle, whose
/// shape functions 2 and 3 count together [hughes2000, section 3.6].
std::vector<ElementPoint> element_points(const std::array<Vec3, 4>& corners,
                                         const std::vector<GaussPoint>& rule);

/// The nodes and elements of a mesh that is to be computed with. Nodes are the mesh's points; those on edges
/// of a single element are fixed.
class Discretisation {
 public:
  /// Throws InputError for a mesh with inverted or degenerate elements, with none, or without free nodes. The
  /// mesh has to outlive it.
  explicit Discretisation(const Mesh& mesh);

  std::size_t n_nodes() const { return mesh_.points.size(); }
  std::size_t n_free() const { return n_free_; }
  const Vec3& point(std::size_t node) const { return mesh_.points[node]; }
  /// Free nodes are numbered without gaps; -1: it is fixed, or of no element.
  int row(std::size_t node) const { return row_[node]; }
  bool is_fixed(std::size_t node) const { return fixed_[node] != 0; }
  /// All points have the same z.
  bool is_planar() const { return planar_; }
  /// Rows of each part of the mesh that has no fixed node.
  const std::vector<std::vector<int>>& floating() const { return floating_; }
  /// Which of these a node is in; -1: none.
  int floating_part(std::size_t node) const { return floating_part_[node]; }

  /// Calls visit(nodes, point) for all points of Gauss's rule of `n` x `n` on all elements; triangles have
  /// their third node twice.
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

/// A symmetric matrix, positive definite but for a known kernel: for each set of unknowns in `floating`, the
/// vector that is 1 on it and 0 elsewhere.
struct LinearSystem {
  Eigen::SparseMatrix<double> matrix;      ///< both triangles
  Eigen::VectorXd scale;                   ///< of each row: Jacobi's scaling D, positive
  Eigen::VectorXd right;                   ///< orthogonal to the kernel
  std::vector<std::vector<int>> floating;  ///< none of them empty
};

/// Conjugate gradients with Jacobi's preconditioner D^-1, from zero, stop at this residual, relative to the
/// right side.
inline constexpr double kCgTolerance = 1e-8;
/// How far off, at most, an eigenvalue of condition_number() may be, relative to itself.
inline constexpr double kEigenvalueTolerance = 1e-3;

/// Of a symmetric operator on vectors of this size, relative to itself to kEigenvalueTolerance. By Lanczos'
/// method with full orthogonalisation [golub2013, sections 10.1 and 10.3], until the residual of the Ritz
/// pair is below that. `project` takes away what is not asked about. Throws InputError when that does not
/// converge.
double largest_eigenvalue(
    Eigen::Index n, const std::function<Eigen::VectorXd(const Eigen::VectorXd&)>& apply,
    const std::function<void(Eigen::VectorXd&)>& project = [](Eigen::VectorXd&) {});

/// By Cholesky's factorisation; on each floating set the first unknown is 0. Throws InputError where the
/// matrix is not as it should be.
Eigen::VectorXd solve_directly(const LinearSystem& system);

/// Iterations of conjugate gradients until kCgTolerance. Throws InputError when they do not get there.
int cg_iterations(const LinearSystem& system);

/// Largest over least eigenvalue, the kernel aside, of D^-1/2 K D^-1/2: what governs those iterations. By
/// Lanczos' method on it and on its inverse. Throws InputError when that does not converge.
double condition_number(const LinearSystem& system);

}  // namespace delquad
