#pragma once

#include <Eigen/SparseCore>
#include <functional>
#include <vector>

namespace delquad {

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
