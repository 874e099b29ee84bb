// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "delquad/mesh.h"
#include "delquad/metrics.h"

// This header proves that curved quads have positive Jacobians. Features use it.

namespace delquad {

/// Bounds of the scaled Jacobian of a curved quad: (x_u x x_v) . n / (|x_u| |x_v|). Here n is the mean normal
/// of the element; a planar element has n up or down, as it runs. The value is in [-1, 1], and 1 if the
/// element's lines cross at right angles, perpendicular to n. If it is positive everywhere, the element does
/// not fold, seen along n.
struct JacobianBounds {
  double proven = -1;  ///< it is nowhere less
  double found = 1;    ///< it is so little at some place; at least `proven`
  bool positive() const { return proven > 0; }
};

ProvenJacobians proven_jacobians(std::span<const JacobianBounds> bounds);

/// Bounds by Bernstein coefficients of numerator and squared denominators, halved until they are close to
/// each other. The source [Johnen, Remacle, Geuzaine 2013, section 3] bounds the Jacobian alone. `nodes` as
/// nodes_of_quad() orders them. Elements at whose places x_u or x_v vanishes are not positive. `enough`:
/// bounds that prove so much are not made closer.
JacobianBounds jacobian_bounds(std::span<const Vec3> nodes, int order, double enough = 1);

/// Returns bounds of an element. Bounds of order 2 hold with and without its middle node, as formats of eight
/// nodes leave it out. For other orders see jacobian_bounds().
JacobianBounds element_bounds(std::span<const Vec3> nodes, int order, double enough = 1);

/// Returns the integral of x_u x x_v, as a unit vector; (0, 0, 0) where it vanishes.
Vec3 mean_normal(std::span<const Vec3> nodes, int order);

/// A polynomial in (u, v) over the unit square, of degrees `du` and `dv`, by its Bernstein coefficients: row
/// j, column i, du + 1 to a row. Its values lie within the range of the coefficients; those at the corners
/// are values there [Farin, Curves and Surfaces for CAGD].
template <class T>
struct Bernstein {
  int du = 0, dv = 0;
  std::vector<T> c;
  const T& at(int i, int j) const { return c[static_cast<std::size_t>(j) * (du + 1) + i]; }
};

/// Returns the map of an element from its nodes, as nodes_of_quad() orders them.
Bernstein<Vec3> bernstein_of(std::span<const Vec3> nodes, int order);

Bernstein<Vec3> derivative_u(const Bernstein<Vec3>& f);
Bernstein<Vec3> derivative_v(const Bernstein<Vec3>& f);
Bernstein<Vec3> cross_product(const Bernstein<Vec3>& f, const Bernstein<Vec3>& g);
Bernstein<double> dot_product(const Bernstein<Vec3>& f, const Bernstein<Vec3>& g);
Bernstein<double> dot_product(const Bernstein<Vec3>& f, const Vec3& n);

Vec3 value_at(const Bernstein<Vec3>& f, double u, double v);

/// Returns the halves of a square, left and right or lower and upper, each over the unit square again.
std::array<Bernstein<double>, 2> halves(const Bernstein<double>& f, bool along_u);

}  // namespace delquad
