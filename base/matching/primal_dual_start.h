#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

#include "base/cancel.h"
#include "base/matching/matching.h"
#include "base/matching/primal_dual_state.h"

/// Dual values and a matching to start from, by passes over the edges: most of a mesh is matched by them.
namespace delquad {

/// Dual values in quarters of the unit of costs, all even.
template <class Value>
struct FirstMatching {
  std::vector<int> degree;
  std::vector<Value> dual;
  std::vector<int> mate;  ///< -1: free
  int n_free = 0;
  int hub = 0;  ///< the most edges of a node that is no hub
};

/// A node of a degree this many times as large as usual is a hub. Half of its cheapest edge says nothing of
/// its neighbours: it takes what they leave.
inline constexpr int kHubFactor = 16;

inline int hub_degree(const MatchingGraph& graph) {
  const std::size_t mean = graph.n_nodes > 0 ? 2 * graph.edges.size() / graph.n_nodes : 0;
  return static_cast<int>(std::min<std::size_t>(kHubFactor * (mean + 1), std::numeric_limits<int>::max()));
}

/// Every edge that is no hub's leaves half of its cost to each end, so that none has negative slack.
template <class Value>
void share_costs(const MatchingGraph& graph, FirstMatching<Value>& first) {
  const int hub = first.hub;
  constexpr long long kNone = std::numeric_limits<long long>::max();
  std::vector<long long> cheapest(graph.n_nodes, kNone);
  bool hubs = false;
  for (const auto& e : graph.edges) {
    if (e.a == e.b) continue;
    const bool a = first.degree[e.a] > hub, b = first.degree[e.b] > hub;
    hubs = hubs || a || b;
    if (!b || a) cheapest[e.a] = std::min(cheapest[e.a], e.cost);
    if (!a || b) cheapest[e.b] = std::min(cheapest[e.b], e.cost);
  }
  for (int v = 0; v < graph.n_nodes; ++v) first.dual[v] = cheapest[v] == kNone ? 0 : 2 * Value{cheapest[v]};
  if (!hubs) return;
  // Two hubs share an edge as any nodes do, and each gives way to its other neighbours.
  for (const auto& e : graph.edges) {
    const bool a = first.degree[e.a] > hub, b = first.degree[e.b] > hub;
    if (a == b) continue;
    Value& dual = first.dual[a ? e.a : e.b];
    dual = std::min(dual, 4 * Value{e.cost} - first.dual[a ? e.b : e.a]);
  }
}

template <class Value>
FirstMatching<Value> first_matching(const MatchingGraph& graph) {
  const int n = graph.n_nodes;
  FirstMatching<Value> first{std::vector<int>(n, 0), std::vector<Value>(n, 0), std::vector<int>(n, -1), n};
  for (const auto& e : graph.edges) {
    ++first.degree[e.a];
    ++first.degree[e.b];
  }
  check_cancelled();
  first.hub = hub_degree(graph);
  share_costs(graph, first);
  check_cancelled();
  for (const auto& e : graph.edges) {
    if (first.mate[e.a] >= 0 || first.mate[e.b] >= 0 || e.a == e.b) continue;
    if (4 * Value{e.cost} != first.dual[e.a] + first.dual[e.b]) continue;
    first.mate[e.a] = e.b;
    first.mate[e.b] = e.a;
    first.n_free -= 2;
  }
  return first;
}

/// The graph in rows, with the first matching; the arcs of a node are in the order of the edges.
template <class Value, class Cost>
void fill_state(const MatchingGraph& graph, const FirstMatching<Value>& first,
                PrimalDualState<Value, Cost>& state) {
  using State = PrimalDualState<Value, Cost>;
  const int n = graph.n_nodes;
  state.hub = first.hub;
  std::size_t apart = 0;
  for (int v = 0; v < n; ++v) {
    auto& node = state.nodes[v];
    node.value = first.dual[v];
    node.container = node.base = v;
    node.mate = first.mate[v];
    if (first.degree[v] > State::kOwnArcs) {
      node.own_arcs[0].to = static_cast<int>(apart);
      apart += first.degree[v];
    }
  }
  state.arcs.resize(apart);
  check_cancelled();
  const auto add = [&](int from, int to, Cost cost) {
    auto& node = state.nodes[from];
    const bool own = first.degree[from] <= State::kOwnArcs;
    (own ? node.own_arcs[node.degree] : state.arcs[node.own_arcs[0].to + node.degree]) = {cost, to};
    ++node.degree;
  };
  for (const auto& e : graph.edges) {
    const Cost cost = static_cast<Cost>(4 * Value{e.cost});
    add(e.a, e.b, cost);
    add(e.b, e.a, cost);
  }
}

/// Raises the dual value of each free node as far as its edges let it, and matches it with a free node that
/// is then tight. Lists the nodes that stay free.
template <class Value, class Cost>
void raise_free_nodes(PrimalDualState<Value, Cost>& state) {
  for (int v = 0; v < state.n_nodes; ++v) {
    if (v % kPerCheck == 0) check_cancelled();
    if (state.nodes[v].mate >= 0) continue;
    Value least = 0;
    int best = -1;
    const auto* const arcs = state.arcs_of(state.nodes[v]);
    for (int a = 0; a < state.nodes[v].degree; ++a) {
      const int w = arcs[a].to;
      if (w == v) continue;
      const Value slack = arcs[a].cost - state.nodes[v].value - state.nodes[w].value;
      const bool better = best < 0 || slack < least || (slack == least && state.nodes[best].mate >= 0);
      if (!better) continue;
      least = slack;
      best = w;
    }
    if (best < 0) continue;
    state.nodes[v].value += least;
    if (state.nodes[best].mate < 0) state.match(v, best);
  }
  for (int v = 0; v < state.n_nodes; ++v) {
    if (state.nodes[v].mate < 0) state.free_nodes.push_back(v);
  }
}

}  // namespace delquad
