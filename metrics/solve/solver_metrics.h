#pragma once

#include <map>
#include <string>
#include <vector>

#include "delquad/metrics.h"
#include "metrics/solve/solve.h"

namespace delquad {

/// "poisson" and "elasticity": what measures may be asked for by.
const std::vector<std::string>& solver_names();
/// Its measures: "poisson_l2" and so on. They cost more than others and are not in metric_registry(): they
/// are there for who asks.
std::vector<Metric> metrics_of_solver(const std::string& solver);

struct SolverOutcome {
  std::map<std::string, double> values;  ///< by key; NaN where they are not defined
  std::string undefined;                 ///< why they are not; empty: they are
};
/// `exact`: of Poisson's equation; empty: the domain's own. Throws InputError for a solver that there is not.
SolverOutcome measure_by_solver(const Mesh& mesh, const std::string& solver, const Solution& exact = {});

}  // namespace delquad
