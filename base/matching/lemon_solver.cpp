// SPDX-License-Identifier: GPL-3.0-or-later
// The only file with LEMON's headers, compiled as C++17, since they are not valid C++20.
#define LEMON_ONLY_TEMPLATES
#include <lemon/matching.h>
#include <lemon/smart_graph.h>

#include <algorithm>
#include <cassert>

#include "base/cancel.h"
#include "base/matching/matching.h"
#include "base/system.h"

namespace delquad {

namespace {

// Extraction of the matching recurses at each level of nested blossoms, which may be as deep as a fraction of
// the nodes.
constexpr std::size_t kMinimumStack = std::size_t{64} << 20;
constexpr std::size_t kStackPerNode = 256;
/// Stack that every thread has left. An own thread costs as much time as some hundred nodes.
constexpr std::size_t kUsualStack = std::size_t{1} << 20;

/// Costs negated for LEMON, which maximizes. Arcs inherit the value of their edge.
class NegatedCosts {
 public:
  using Key = lemon::SmartGraph::Edge;
  using Value = long long;
  explicit NegatedCosts(const MatchingGraph& graph) : edges_(graph.edges) {}
  Value operator[](const Key& e) const { return -edges_[lemon::SmartGraph::id(e)].cost; }

 private:
  const std::vector<MatchingGraph::Edge>& edges_;
};

MatchingResult match(const MatchingGraph& graph) {
  assert(std::all_of(graph.edges.begin(), graph.edges.end(),
                     [](const auto& e) { return e.cost >= 0 && e.a != e.b; }));
  MatchingResult result;
  if (graph.n_nodes % 2 != 0) return result;
  lemon::SmartGraph g;
  g.reserveNode(graph.n_nodes);
  g.reserveEdge(static_cast<int>(graph.edges.size()));
  for (int i = 0; i < graph.n_nodes; ++i) g.addNode();
  for (const MatchingGraph::Edge& e : graph.edges) g.addEdge(g.nodeFromId(e.a), g.nodeFromId(e.b));
  const NegatedCosts costs(graph);
  lemon::MaxWeightedPerfectMatching<lemon::SmartGraph, NegatedCosts> matching(g, costs);
  if (!matching.run()) return result;
  result.status = MatchingStatus::kOptimal;
  result.cost = -matching.matchingWeight();
  result.mate.resize(graph.n_nodes);
  for (int i = 0; i < graph.n_nodes; ++i) result.mate[i] = g.id(matching.mate(g.nodeFromId(i)));
  return result;
}

class LemonSolver final : public MatchingSolver {
 public:
  std::string name() const override { return "lemon"; }

  /// Solves by LEMON, which cannot be interrupted: cancellation waits for its end.
  MatchingResult solve(const MatchingGraph& graph) const override {
    check_cancelled();
    const std::size_t needed = kStackPerNode * static_cast<std::size_t>(graph.n_nodes);
    if (needed <= kUsualStack) return match(graph);
    MatchingResult result;
    call_on_stack(std::max(kMinimumStack, needed), [&] { result = match(graph); });
    return result;
  }
};

}  // namespace

std::unique_ptr<MatchingSolver> make_lemon_solver() { return std::make_unique<LemonSolver>(); }

}  // namespace delquad
