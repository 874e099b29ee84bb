#pragma once

#include "mesher/runner.h"

namespace delquad {

/// How a mesh got curved elements.
struct CurvingSummary {
  int order = 1;
  int poor = 0, improved = 0;    ///< see UntanglingSummary
  int unproven = 0;              ///< elements whose scaled Jacobian is not proven to be positive
  double least_jacobian = 1;     ///< the least proven scaled Jacobian
  double mean_jacobian = 1;      ///< the mean of the proven ones
  double distance = 0;           ///< the greatest from curved elements to the model, in its diagonals
  double distance_straight = 0;  ///< the same of the straight ones
  double seconds = 0;
};

template <>
struct Counters<CurvingSummary> {
  using S = CurvingSummary;
  static constexpr const char* step = "curving";
  static constexpr auto all = std::tuple{counter("order", &S::order),
                                         counter("poor", &S::poor),
                                         counter("improved", &S::improved),
                                         counter("unproven", &S::unproven),
                                         counter("least_jacobian", &S::least_jacobian),
                                         counter("mean_jacobian", &S::mean_jacobian),
                                         counter("distance", &S::distance),
                                         counter("distance_straight", &S::distance_straight),
                                         counter("seconds", &S::seconds)};
};

/// Gives a sound mesh the elements of the problem's order. Those that are not proven to be positive are a
/// reason why it is not sound. Throws InputError where triangles are left.
void curve_mesh(const PreparedProblem& prepared, const SurfaceNodes& nodes, RunResult& result);

}  // namespace delquad
