// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <tuple>
#include <vector>

#include "base/counters.h"
#include "delquad/metrics.h"
#include "geometry/patches/meshing_setup.h"

// This header makes curved elements from a straight mesh. The pipeline and features use it.

namespace delquad {

/// Result of curving a mesh. Jacobians are scaled, in [-1, 1].
struct CurvingSummary {
  int order = 1;
  int poor = 0, improved = 0;     ///< see UntanglingSummary
  int unproven = 0;               ///< elements without a proof that their scaled Jacobian is positive
  int unproven_elsewhere = 0;     ///< unproven elements that no narrow corner of the model explains
  double least_jacobian = 1;      ///< least proven scaled Jacobian
  double least_elsewhere = 1;     ///< least one that no narrow corner of the model explains
  int below = 0, in_corners = 0;  ///< elements below kLowJacobian; number that narrow corners explain
  double mean_jacobian = 1;       ///< mean proven scaled Jacobian
  double distance = 0;            ///< largest distance of curved elements from the model, in its diagonals
  double distance_straight = 0;   ///< the same for the straight elements
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

/// Divides quads of the straight mesh that have flat corners between two curves into five quads, if the
/// problem asks for curved elements. Returns the number of divided quads. Own method (docs/algorithms.md,
/// curved elements).
int split_flat_corners(const MeshingSetup& prepared, const SurfaceNodes& nodes, Mesh& mesh);

/// Gives a sound mesh elements of the problem's order. Elements that are not proven to be positive make the
/// mesh unsound. Returns whether vertices of the straight mesh moved. Throws InputError if triangles are
/// left.
bool curve_mesh(const MeshingSetup& prepared, const SurfaceNodes& nodes, Mesh& mesh, Soundness& soundness,
                std::vector<Warning>& warnings, CurvingSummary& summary);

/// Returns the mesh of straight elements with the same vertices.
Mesh straight_form(const Mesh& curved);

}  // namespace delquad
