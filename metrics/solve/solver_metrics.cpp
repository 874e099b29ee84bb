// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrics/solve/solver_metrics.h"

#include <algorithm>
#include <limits>

#include "base/nearest_name.h"
#include "delquad/error.h"

namespace delquad {
namespace {

struct Solver {
  std::string name, title;
  SolverErrors (*solve)(const Mesh&, const Solution&);
};

const std::vector<Solver>& solvers() {
  static const std::vector<Solver> all = {
      {"poisson", "Poisson",
       [](const Mesh& mesh, const Solution& exact) {
         return exact ? solve_poisson(mesh, exact, kGaussPointsInLayers) : solve_poisson(mesh);
       }},
      {"elasticity", "elasticity", [](const Mesh& mesh, const Solution&) { return solve_elasticity(mesh); }}};
  return all;
}

/// One number of a solver.
struct Part {
  const char *key, *title, *source;
  int digits;
  double (*of)(const SolverErrors&);
};

constexpr Part kParts[] = {
    {"_l2", " L2", "error in L2, divided by the solution", 6, [](const SolverErrors& e) { return e.l2; }},
    {"_h1", " H1", "error of the gradients in L2, divided by the gradients of the solution", 6,
     [](const SolverErrors& e) { return e.h1; }},
    {"_condition", " condition", "condition number of the stiffness matrix with Jacobi's scaling by node", 1,
     [](const SolverErrors& e) { return e.condition; }},
    {"_cg_iterations", " CG", "iterations of conjugate gradients with Jacobi's preconditioner to 1e-8", 0,
     [](const SolverErrors& e) { return static_cast<double>(e.cg_iterations); }}};

const Solver& find_solver(const std::string& name) {
  const auto at = std::ranges::find(solvers(), name, &Solver::name);
  if (at != solvers().end()) return *at;
  const std::string near = suggestion(name, solver_names());
  throw InputError("unknown solver '" + name + "'" +
                   (near.empty() ? ": expected poisson or elasticity" : near));
}

}  // namespace

const std::vector<std::string>& solver_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> result;
    for (const Solver& solver : solvers()) result.push_back(solver.name);
    return result;
  }();
  return names;
}

std::vector<Metric> metrics_of_solver(const std::string& name) {
  const Solver& solver = find_solver(name);
  std::vector<Metric> metrics;
  for (const Part& part : kParts)
    metrics.push_back({name + part.key, solver.title + part.title, "", Better::kLower,
                       std::numeric_limits<double>::infinity(), part.source, part.digits});
  return metrics;
}

SolverOutcome measure_by_solver(const Mesh& mesh, const std::string& name, const Solution& exact) {
  const Solver& solver = find_solver(name);
  SolverOutcome outcome;
  for (const Part& part : kParts) outcome.values[name + part.key] = std::numeric_limits<double>::quiet_NaN();
  try {
    const SolverErrors errors = solver.solve(mesh, exact);
    for (const Part& part : kParts) outcome.values[name + part.key] = part.of(errors);
  } catch (const InputError& error) {
    outcome.undefined = error.what();
  }
  return outcome;
}

}  // namespace delquad
