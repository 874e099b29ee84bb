// SPDX-License-Identifier: GPL-3.0-or-later
// coarse: matches by costs that are rounded to a few levels, to measure the worth of the resolution.
#include <delquad/bench.h>
#include <delquad/extend.h>
#include <delquad/matching.h>

#include <algorithm>

namespace {

using namespace delquad;

class Coarse final : public MatchingSolver {
 public:
  explicit Coarse(const Options& options)
      : exact_(matching_solver("primal-dual")), levels_(options.integer("coarse.levels")) {}
  std::string name() const override { return "coarse"; }

  MatchingResult solve(const MatchingGraph& graph) const override {
    MatchingGraph rounded = graph;
    long long most = 1;
    for (const MatchingGraph::Edge& edge : graph.edges) most = std::max(most, edge.cost);
    const long long step = std::max(1LL, most / levels_);
    for (MatchingGraph::Edge& edge : rounded.edges) edge.cost = edge.cost / step;
    MatchingResult result = exact_->solve(rounded);
    result.cost = 0;  // the cost in the given graph
    for (const MatchingGraph::Edge& edge : graph.edges)
      if (result.status == MatchingStatus::kOptimal && result.mate[edge.a] == edge.b)
        result.cost += edge.cost;
    result.fields = {{"step_of_costs", step, Over::kMost}};
    return result;
  }

 private:
  std::unique_ptr<MatchingSolver> exact_;
  long long levels_;
};

}  // namespace

int main(int argc, char** argv) {
  add_options({.name = "coarse",
               .help = "options of the matching solver \"coarse\"",
               .keys = {{.name = "levels", .help = "of costs", .value = 10, .least = 1, .most = 1e6}}});
  add_matching_solver("coarse", [](const Options& options) { return std::make_unique<Coarse>(options); });
  return run_program(argc, argv);
}
