#pragma once

#include <array>
#include <functional>
#include <vector>

#include "delquad/mesh.h"

namespace delquad {

/// What a solver says of a mesh.
struct SolverErrors {
  double l2 = 0;         ///< |u - u_h| over |u|, in L2
  double h1 = 0;         ///< |grad (u - u_h)| over |grad u|, in L2
  double condition = 0;  ///< of the stiffness matrix, see condition_number()
  int cg_iterations = 0;
};

/// A field of space with its gradient.
struct ScalarSolution {
  double value;
  Vec3 gradient;
};
/// A displacement of the plane.
struct VectorSolution {
  std::array<double, 2> value;
  std::array<Vec3, 2> gradient;  ///< of each component
};

using Solution = std::function<ScalarSolution(const Vec3&)>;

/// Gauss points for solutions that have layers, which elements need not resolve.
inline constexpr int kGaussPointsInLayers = 5;

/// Poisson's equation on a mesh of the plane or of a surface (Laplace-Beltrami), with bilinear quads and
/// linear triangles. Nodes on free edges have the values of `exact`; parts without any are solved up to a
/// constant, by which u_h then has the mean of u.
///
/// The right side is the weak one, the integral of grad u . grad v: u_h is the Ritz projection of u, and its
/// error that of the approximation [brenner2008, section 5.4]. The matrix by 2 x 2 Gauss points, the right
/// side by n x n, errors by one more in each direction. On a surface u is taken on the mesh itself, not on
/// what it approximates.
///
/// Throws InputError for a mesh with inverted or degenerate elements, or without unknowns, saying so.
SolverErrors solve_poisson(const Mesh& mesh, const Solution& exact, int gauss_points = 2);
/// u_h alone, at the points of the mesh.
std::vector<double> poisson_solution(const Mesh& mesh, const Solution& exact, int gauss_points);
/// The solution that belongs to the domain: in the plane a sine of the squared distance from its centroid, so
/// that it turns, moves and grows with the domain; in space a product of sines of the coordinates, scaled by
/// the radius of gyration.
SolverErrors solve_poisson(const Mesh& mesh);

/// Linear elasticity of a mesh of the plane (plane stress, Young's modulus 1, Poisson's ratio 0.3) in the
/// same way; the displacement is given on free edges. Throws InputError also for a mesh in space.
SolverErrors solve_elasticity(const Mesh& mesh, const std::function<VectorSolution(const Vec3&)>& exact);
/// The displacement that belongs to the domain: away from and around its centroid by functions of the squared
/// distance.
SolverErrors solve_elasticity(const Mesh& mesh);

/// The largest stable step of central differences for waves of speed 1 in a membrane that the mesh is: 2 over
/// the largest frequency [hughes2000, section 9.1], with bilinear quads and linear triangles by 2 x 2 Gauss
/// points, quads projected to their middle planes, and masses lumped by rows. By Lanczos' method, to half of
/// kEigenvalueTolerance. A mesh of squares has their side. 0 where an element is inverted or flat at a point,
/// not a number where the method does not converge.
double critical_step(const Mesh& mesh);

}  // namespace delquad
