// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <string>
#include <vector>

#include "delquad/metrics.h"
#include "metrics/solve/solve.h"

// This header has measures by finite elements. Experiments and the program use it.

namespace delquad {

/// Returns "poisson" and "elasticity", the solvers that measures can use.
const std::vector<std::string>& solver_names();
/// Returns the measures of a solver: "poisson_l2" and so on. They cost more than others, so they are on
/// request and not in metric_registry().
std::vector<Metric> metrics_of_solver(const std::string& solver);

struct SolverOutcome {
  std::map<std::string, double> values;  ///< by key; NaN if not defined
  std::string undefined;                 ///< reason for missing values; empty: none is missing
};
/// Returns the measures of a solver. `exact` is the solution of Poisson's equation; empty: made from the
/// domain. Throws InputError for an unknown solver.
SolverOutcome measure_by_solver(const Mesh& mesh, const std::string& solver, const Solution& exact = {});

}  // namespace delquad
