// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/SparseCore>
#include <array>
#include <complex>
#include <vector>

#include "algorithms/fields/laplace.h"
#include "delquad/mesh.h"

// This header diffuses crosses over the triangles of patches. Fields use it.

namespace delquad {

/// The crosses of a patch as unknowns on its sides.
struct PatchUnknowns {
  const TriPatch* tri;
  Sides sides;
  std::vector<int> unknown;       ///< of each side; sides that are shared have one unknown
  std::vector<double> direction;  ///< 4 theta that the unknown is counted from, on this side
  /// For each triangle, the turn of 4 theta from the centroid to the middles of its sides.
  const std::vector<std::array<double, 3>>* turns;

  /// Returns by how much 4 theta of the k-th side of triangle t, counted from its direction, exceeds the
  /// centroid's (radians).
  double phase(int t, int k) const { return (*turns)[t][k] - direction[sides.of_triangle[t][k]]; }
};

/// Diffusion (mass/tau + stiffness) of crosses that turn as grids of a size do, where some are given. Time is
/// counted in elements (pairs of triangles), wherever they are. The stiffness of each triangle is taken
/// between values carried to its centroid, so that it is positive semi-definite whatever its angles.
class CrossDiffusion {
 public:
  using Complex = std::complex<double>;
  /// Role of an unknown: it is given (kGiven), else drawn to its direction with this strength, >= 0. A
  /// triangle's stiffness is about 1.
  static constexpr double kGiven = -1;

  /// Begins with `z`: the unknowns, of unit length, which must stay; `alignment`: of each.
  CrossDiffusion(const std::vector<PatchUnknowns>& patches, const std::vector<double>& alignment,
                 std::vector<Complex>& z);
  /// Makes one step of diffusion over `tau` elements, up to a relative residual, then back to unit length.
  void step(double tau, double tolerance);

 private:
  void add_triangle(const PatchUnknowns& patch, int t, std::vector<Eigen::Triplet<double>>& entries);

  std::vector<Complex>& z_;
  std::vector<int> row_;   ///< of each unknown; -1: it is given
  Eigen::VectorXd mass_;   ///< real and imaginary parts in turn, as everywhere here
  Eigen::VectorXd fixed_;  ///< what given values and directions contribute
  Eigen::SparseMatrix<double, Eigen::RowMajor> stiffness_;
};

}  // namespace delquad
