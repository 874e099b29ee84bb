// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <tuple>
#include <vector>

#include "base/counters.h"
#include "delquad/metrics.h"
#include "geometry/patches/meshing_setup.h"

// This header makes curved elements from a straight mesh. The pipeline and features use it.

namespace delquad {

/// How a mesh got curved elements.
struct CurvingSummary {
  int order = 1;
  int poor = 0, improved = 0;     ///< see UntanglingSummary
  int unproven = 0;               ///< elements whose scaled Jacobian is not proven to be positive
  int unproven_elsewhere = 0;     ///< those that no narrow corner of the model explains
  double least_jacobian = 1;      ///< the least proven scaled Jacobian
  double least_elsewhere = 1;     ///< the least that no narrow corner of the model explains
  int below = 0, in_corners = 0;  ///< elements below kLowJacobian, and those that narrow corners explain
  double mean_jacobian = 1;       ///< the mean of the proven ones
  double distance = 0;            ///< the greatest from curved elements to the model, in its diagonals
  double distance_straight = 0;   ///< the same of the straight ones
};

template <>
struct Counters<CurvingSummary> {
  using S = CurvingSummary;
  static constexpr const char* step = "curving";
  static constexpr auto all = std::tuple{counter("order", &S::order),
                                         counter("poor", &S::poor),
                                         counter("improved", &S::improved),
                                         counter("unproven", &S::unproven),
                                         counter("unproven_elsewhere", &S::unproven_elsewhere),
                                         counter("least_jacobian", &S::least_jacobian),
                                         counter("least_elsewhere", &S::least_elsewhere),
                                         counter("below", &S::below),
                                         counter("in_corners", &S::in_corners),
                                         counter("mean_jacobian", &S::mean_jacobian),
                                         counter("distance", &S::distance),
                                         counter("distance_straight", &S::distance_straight)};
};

/// Parts quads of the straight mesh that have flat corners, where the problem asks for curved elements.
/// Returns how many.
int split_flat_corners(const MeshingSetup& prepared, const SurfaceNodes& nodes, Mesh& mesh);

/// Gives a sound mesh the elements of the problem's order. Elements that are not proven to be positive make
/// the mesh unsound. Returns whether vertices of the straight mesh moved. Throws InputError if triangles are
/// left.
bool curve_mesh(const MeshingSetup& prepared, const SurfaceNodes& nodes, Mesh& mesh, Soundness& soundness,
                std::vector<Warning>& warnings, CurvingSummary& summary);

/// Returns the mesh of straight elements with the same vertices.
Mesh straight_form(const Mesh& curved);

}  // namespace delquad
