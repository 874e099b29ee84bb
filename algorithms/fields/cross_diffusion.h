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
  std::vector<int> unknown;       ///< unknown of each side; joined sides have one
  std::vector<double> direction;  ///< 4 theta, radians, from which the unknown of a side is counted
  /// For each triangle, the turn of 4 theta (radians) from the centroid to the middles of its sides.
  const std::vector<std::array<double, 3>>* turns;

  /// Returns by how much 4 theta of the k-th side of triangle t, counted from its direction, exceeds the
  /// centroid's (radians).
  double phase(int t, int k) const { return (*turns)[t][k] - direction[sides.of_triangle[t][k]]; }
};

/// Implicit diffusion (mass/tau + stiffness) of crosses in the connection of SizeAwareCrossField (own
/// method); some are given. Time is counted in elements (pairs of triangles) of any size. The stiffness of
/// each triangle is taken between values carried to its centroid, so that it is positive semi-definite
/// whatever its angles.
class CrossDiffusion {
 public:
  using Complex = std::complex<double>;
  /// Alignment of an unknown that is given. Other alignments, >= 0, are strengths that draw it to its
  /// direction; the stiffness of a triangle is about 1.
  static constexpr double kGiven = -1;

  /// Begins with the unknowns `z`, of unit length, which must outlive this object; `alignment` has one for
  /// each.
  CrossDiffusion(const std::vector<PatchUnknowns>& patches, const std::vector<double>& alignment,
                 std::vector<Complex>& z);
  /// Makes one step of diffusion over `tau` > 0 elements, to a relative residual of `tolerance`. Then scales
  /// all unknowns to unit length.
  void step(double tau, double tolerance);

 private:
  void add_triangle(const PatchUnknowns& patch, int t, std::vector<Eigen::Triplet<double>>& entries);

  std::vector<Complex>& z_;
  std::vector<int> row_;   ///< row of each unknown; -1: it is given
  Eigen::VectorXd mass_;   ///< real and imaginary parts in turn, as everywhere here
  Eigen::VectorXd fixed_;  ///< right side from given values and directions
  Eigen::SparseMatrix<double, Eigen::RowMajor> stiffness_;
};

}  // namespace delquad
