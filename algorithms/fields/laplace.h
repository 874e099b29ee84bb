// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <span>
#include <vector>

#include "delquad/mesh.h"

// This header solves Laplace's equation on triangulations. Cross fields and sizes use it.

namespace delquad {

/// Products of a triangle's sides (each opposite to its vertex) over twice its area. This is twice the
/// stiffness matrix of the continuous linear element, and half of the matrix of the Crouzeix-Raviart element.
/// It is positive semi-definite also for slivers.
using LocalStiffness = std::array<std::array<double, 3>, 3>;
/// Returns the products of triangle t.
LocalStiffness local_stiffness(const TriPatch& tri, int t);

/// Extends values harmonically by finite elements linear on each triangle. dofs[t][k] numbers the unknown of
/// triangle t at its vertex k for continuous elements. For Crouzeix-Raviart elements it is at the middle of
/// its side opposite to vertex k. Both have the same matrix, up to a factor. Each column has a value for each
/// unknown: given if `fixed`, else the result. One factorization serves all columns. Throws Error if rounding
/// makes the matrix singular.
void solve_laplace(const TriPatch& tri, const std::vector<std::array<int, 3>>& dofs,
                   const std::vector<char>& fixed, std::span<std::vector<double>> columns);

/// Numbers of the sides of a triangulation, from 0, in the order of the triangles.
struct Sides {
  std::vector<std::array<int, 3>> of_triangle;  ///< the side opposite to each vertex
  int count = 0;
};
Sides number_sides(const TriPatch& tri);

}  // namespace delquad
