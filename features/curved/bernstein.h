#pragma once

#include <array>
#include <span>
#include <vector>

#include "delquad/mesh.h"

namespace delquad {

/// A polynomial in (u, v) over the unit square, of degrees `du` and `dv`, by its Bernstein coefficients: row
/// j, column i, du + 1 to a row. Its values lie within the range of the coefficients; those at the corners
/// are values there [Farin, Curves and Surfaces for CAGD].
template <class T>
struct Bernstein {
  int du = 0, dv = 0;
  std::vector<T> c;
  const T& at(int i, int j) const { return c[static_cast<std::size_t>(j) * (du + 1) + i]; }
};

/// The map of an element from its nodes, as nodes_of_quad() orders them.
Bernstein<Vec3> bernstein_of(std::span<const Vec3> nodes, int order);

Bernstein<Vec3> derivative_u(const Bernstein<Vec3>& f);
Bernstein<Vec3> derivative_v(const Bernstein<Vec3>& f);
Bernstein<Vec3> cross_product(const Bernstein<Vec3>& f, const Bernstein<Vec3>& g);
Bernstein<double> dot_product(const Bernstein<Vec3>& f, const Bernstein<Vec3>& g);
Bernstein<double> dot_product(const Bernstein<Vec3>& f, const Vec3& n);

Vec3 value_at(const Bernstein<Vec3>& f, double u, double v);

/// The halves of a square, left and right or lower and upper, each over the unit square again.
std::array<Bernstein<double>, 2> halves(const Bernstein<double>& f, bool along_u);

}  // namespace delquad
