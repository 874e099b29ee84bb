// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "delquad/mesh.h"

// This header solves model problems on a mesh. Measures by solvers and criteria use it.

namespace delquad {

/// Errors of a solver on a mesh.
struct SolverErrors {
  double l2 = 0;         ///< |u - u_h| over |u|, in L2
  double h1 = 0;         ///< |grad (u - u_h)| over |grad u|, in L2
  double condition = 0;  ///< condition of the stiffness matrix, see condition_number()
  int cg_iterations = 0;
};

/// A field in space with its gradient.
struct ScalarSolution {
  double value;
  Vec3 gradient;
};
/// A displacement in the plane.
struct VectorSolution {
  std::array<double, 2> value;
  std::array<Vec3, 2> gradient;  ///< gradient of each component
};

using Solution = std::function<ScalarSolution(const Vec3&)>;

/// Gauss points for solutions with layers that elements need not resolve.
inline constexpr int kGaussPointsInLayers = 5;

/// Returns the errors of Poisson's equation on a mesh of the plane or of a surface (Laplace-Beltrami), with
/// bilinear quads and linear triangles. Nodes on free edges have the values of `exact`. Parts without free
/// edges are solved up to a constant, and u_h gets the mean of u.
///
/// The right side is the weak one, the integral of grad u . grad v. So u_h is the Ritz projection of u, with
/// the error of approximation [brenner2008, section 5.4]. The matrix takes 2 x 2 Gauss points, the right side
/// n x n, errors one more in each direction. On a surface u is evaluated on the mesh itself.
///
/// Throws InputError for inverted or degenerate elements, and for no unknowns.
SolverErrors solve_poisson(const Mesh& mesh, const Solution& exact, int gauss_points = 2);
/// Returns u_h at the points of the mesh. Throws InputError as solve_poisson().
std::vector<double> poisson_solution(const Mesh& mesh, const Solution& exact, int gauss_points);
/// Solves for a solution made from the domain. In the plane it is a sine of the squared distance from the
/// centroid, so it turns, moves and grows with the domain. In space it is a product of sines of coordinates,
/// scaled by the radius of gyration.
SolverErrors solve_poisson(const Mesh& mesh);

/// Solves linear elasticity on a mesh of the plane (plane stress, Young's modulus 1, Poisson's ratio 0.3)
/// likewise. Displacements are given on free edges. Throws InputError also for a mesh in space.
SolverErrors solve_elasticity(const Mesh& mesh, const std::function<VectorSolution(const Vec3&)>& exact);
/// Solves for a displacement made from the domain: away from and around its centroid, by functions of the
/// squared distance.
SolverErrors solve_elasticity(const Mesh& mesh);

/// Returns the largest stable step of central differences for waves of speed 1 in a membrane of the mesh's
/// shape. It is 2 over the largest frequency [hughes2000, section 9.1]. Quads are bilinear and flattened to
/// their middle planes, triangles linear, by 2 x 2 Gauss points; masses are lumped by rows. Lanczos' method
/// gives half of kEigenvalueTolerance. A mesh of squares has their side. Returns 0 for an inverted or flat
/// element, and NaN without convergence.
double critical_step(const Mesh& mesh);

}  // namespace delquad
