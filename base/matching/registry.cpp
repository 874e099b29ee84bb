// SPDX-License-Identifier: GPL-3.0-or-later
#include <utility>

#include "base/added_parts.h"
#include "base/located.h"
#include "base/matching/matching.h"
#include "base/nearest_name.h"
#include "delquad/error.h"

namespace delquad {
namespace {

AddedParts<MatchingSolverFactory>& solvers() {
  static AddedParts<MatchingSolverFactory> all = [] {
    AddedParts<MatchingSolverFactory> parts("matching solver");
    parts.add("primal-dual", [](const Options&) { return make_primal_dual_solver(); });
    parts.add("lemon", [](const Options&) { return make_lemon_solver(); });
    return parts;
  }();
  return all;
}

/// A solver whose results are checked, since added ones cannot be trusted.
class CheckedSolver final : public MatchingSolver {
 public:
  CheckedSolver(std::string name, std::unique_ptr<MatchingSolver> solver)
      : name_(std::move(name)), solver_(std::move(solver)) {
    if (!solver_) throw Error("matching solver '" + name_ + "': its factory returned none");
  }

  std::string name() const override { return name_; }

  MatchingResult solve(const MatchingGraph& graph) const override {
    MatchingResult result = solver_->solve(graph);
    if (result.status == MatchingStatus::kOptimal) check(graph, result);
    return result;
  }

 private:
  [[noreturn]] void refuse(const std::string& what) const {
    throw Error("matching solver '" + name_ + "': its result " + what);
  }

  void check(const MatchingGraph& graph, const MatchingResult& result) const {
    if (result.mate.size() != static_cast<std::size_t>(graph.n_nodes))
      refuse("has " + std::to_string(result.mate.size()) + " partners for " + std::to_string(graph.n_nodes) +
             " nodes");
    long long pairs = 0, cost = 0;
    for (const MatchingGraph::Edge& edge : graph.edges) {
      if (result.mate[edge.a] != edge.b || result.mate[edge.b] != edge.a) continue;
      ++pairs;
      cost += edge.cost;
    }
    if (2 * pairs != graph.n_nodes) refuse("is no perfect matching of the graph's edges");
    if (cost != result.cost)
      refuse("says that it costs " + std::to_string(result.cost) + ", but it costs " + std::to_string(cost));
  }

  std::string name_;
  std::unique_ptr<MatchingSolver> solver_;
};

}  // namespace

void add_matching_solver(const std::string& name, MatchingSolverFactory factory) {
  solvers().add(name, std::move(factory));
}

std::unique_ptr<MatchingSolver> matching_solver(const std::string& name, const Options& options) {
  if (const auto* make = solvers().find(name)) return std::make_unique<CheckedSolver>(name, (*make)(options));
  std::string known;
  for (const std::string& other : matching_solver_names()) known += (known.empty() ? "" : ", ") + other;
  refuse("unknown matching solver '{}'; known: {}{}", name, known, suggestion(name, matching_solver_names()));
}

std::vector<std::string> matching_solver_names() { return solvers().names(); }

}  // namespace delquad
