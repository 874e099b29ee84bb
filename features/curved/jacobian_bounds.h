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
/// of the element; for a planar element it points up or down, by its orientation. The value is in [-1, 1],
/// and 1 if the lines of the element cross at right angles, perpendicular to n. If it is positive everywhere,
/// the element does not fold, seen along n.
struct JacobianBounds {
  double proven = -1;  ///< lower bound
  double found = 1;    ///< a value that occurs, at least `proven`
  bool positive() const { return proven > 0; }
};

/// Returns the least and mean bound, and the number that is not positive.
ProvenJacobians proven_jacobians(std::span<const JacobianBounds> bounds);

/// Returns bounds by Bernstein coefficients of the numerator and the squared denominators, which are halved
/// until they are close to each other. The source [johnen2013, section 3] bounds the Jacobian alone. `nodes`
/// are in the order of nodes_of_quad(), and `order` is from 1 to 4. An element is not positive if x_u or x_v
/// vanishes somewhere. Bounds that prove `enough` are not refined.
JacobianBounds jacobian_bounds(std::span<const Vec3> nodes, int order, double enough = 1);

/// Returns bounds of an element as jacobian_bounds(). For order 2 they hold with and without the middle node,
/// which formats of eight nodes leave out.
JacobianBounds element_bounds(std::span<const Vec3> nodes, int order, double enough = 1);

/// Returns the integral of x_u x x_v as a unit vector; (0, 0, 0) if it vanishes.
Vec3 mean_normal(std::span<const Vec3> nodes, int order);

/// A polynomial in (u, v) over the unit square, of degrees `du` and `dv`, by its Bernstein coefficients: row
/// j, column i, du + 1 to a row. Its values lie within the range of the coefficients; coefficients at the
/// corners are values there [johnen2013].
template <class T>
struct Bernstein {
  int du = 0, dv = 0;
  std::vector<T> c;
  const T& at(int i, int j) const { return c[static_cast<std::size_t>(j) * (du + 1) + i]; }
};

/// Returns the map of an element from its nodes, in the order of nodes_of_quad().
Bernstein<Vec3> bernstein_of(std::span<const Vec3> nodes, int order);

Bernstein<Vec3> derivative_u(const Bernstein<Vec3>& f);
Bernstein<Vec3> derivative_v(const Bernstein<Vec3>& f);
Bernstein<Vec3> cross_product(const Bernstein<Vec3>& f, const Bernstein<Vec3>& g);
Bernstein<double> dot_product(const Bernstein<Vec3>& f, const Bernstein<Vec3>& g);
Bernstein<double> dot_product(const Bernstein<Vec3>& f, const Vec3& n);

Vec3 value_at(const Bernstein<Vec3>& f, double u, double v);

/// Returns the polynomial on the left and right half of the square (`along_u`), or on the lower and upper
/// half, each over the unit square again.
std::array<Bernstein<double>, 2> halves(const Bernstein<double>& f, bool along_u);

}  // namespace delquad
