// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cstddef>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "base/cancel.h"
#include "base/matching/matching.h"
#include "base/matching/primal_dual_levels.h"
#include "base/matching/primal_dual_state.h"
#include "base/matching/wide.h"

namespace delquad {

namespace {

/// First dual values and matching, by passes over the edges: they match most of a mesh.

/// Dual values in quarters of the unit of costs, all even.
template <class Value>
struct FirstMatching {
  std::vector<int> degree;
  std::vector<Value> dual;
  std::vector<int> mate;  ///< -1: free
  int n_free = 0;
  int hub = 0;  ///< largest degree of a node that is no hub
};

/// A node with this multiple of the usual degree is a hub. Half of its cheapest edge tells nothing about its
/// neighbors, so it takes the rest of their costs.
inline constexpr int kHubFactor = 16;

inline int hub_degree(const MatchingGraph& graph) {
  const std::size_t mean = graph.n_nodes > 0 ? 2 * graph.edges.size() / graph.n_nodes : 0;
  return static_cast<int>(std::min<std::size_t>(kHubFactor * (mean + 1), std::numeric_limits<int>::max()));
}

/// Gives half the cost of every edge outside of hubs to each end, so that no slack is negative.
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
  // Two hubs share an edge like other nodes, and each leaves its other neighbors their share.
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

/// Fills the graph in rows, with the first matching; arcs of a node are in the order of edges.
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

/// Raises the dual value of each free node as far as its edges allow. Matches it with a free node if their
/// edge is tight. Lists the remaining free nodes.
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

/// Bound of times, dual values and sums with them, over a bound of the cost of a matching (docs/matching.md).
constexpr int kBoundFactor = 16;

template <class Value>
std::vector<WideInteger> narrow_all(const std::vector<Value>& values) {
  std::vector<WideInteger> result;
  result.reserve(values.size());
  for (const Value value : values) result.push_back(narrow(value));
  return result;
}

/// Opens all blossoms from outside in, and records them.
template <class Value, class Cost>
void open_blossoms(PrimalDualState<Value, Cost>& state, MatchingCertificate& certificate) {
  struct Open {
    int container, parent;
    Value around;  ///< sum of dual values of all blossoms around it
  };
  std::vector<Open> left;
  std::vector<Value> total(state.n_nodes);
  for (int v = state.n_nodes - 1; v >= 0; --v) {
    total[v] = state.nodes[v].value + state.nodes[state.nodes[v].container].offset;
    if (state.nodes[v].container == v && state.nodes[v].blossom >= 0) left.push_back({v, -1, 0});
  }
  for (unsigned opened = 0; !left.empty(); ++opened) {
    if (opened % kPerCheck == 0) check_cancelled();
    const Open open = left.back();
    left.pop_back();
    const auto& node = state.nodes[open.container];
    const Value dual = node.offset - state.blossoms[node.blossom].origin;
    const int b = static_cast<int>(certificate.blossom_dual.size());
    certificate.blossom_dual.push_back(narrow(dual));
    certificate.blossom_parent.push_back(open.parent);
    const Value around = open.around + dual;
    for (const auto& child : state.expand(open.container, node.offset)) {
      if (child.blossom >= 0) {
        left.push_back({child.container, b, around});
      } else {
        certificate.node_blossom[child.container] = b;
        total[child.container] -= around;
      }
    }
  }
  certificate.node_dual = narrow_all(total);
}

/// Returns nothing if the numbers are too narrow.
template <class Value, class Cost>
std::optional<MatchingResult> solve_with(const MatchingGraph& graph, Value time_limit) {
  MatchingResult result;
  MatchingCertificate& certificate = result.certificate;
  FirstMatching<Value> first = first_matching<Value>(graph);
  certificate.node_blossom.assign(graph.n_nodes, -1);
  if (first.n_free == 0) {
    result.mate = std::move(first.mate);
    certificate.node_dual = narrow_all(first.dual);
    return result;
  }
  PrimalDualState<Value, Cost> state(graph.n_nodes);
  fill_state(graph, first, state);
  first = {};
  check_cancelled();
  raise_free_nodes(state);
  PrimalDualLevels<Value, Cost> levels(state, time_limit);
  // So far totals are even and costs multiples of four, so two even nodes meet after an integral number of
  // units.
  SearchOutcome outcome = levels.run(true, 4);
  if (outcome == SearchOutcome::kDone) outcome = levels.run(false, 2);
  if (outcome == SearchOutcome::kOverflow) return std::nullopt;
  result.contractions = levels.contractions;
  result.expansions = levels.expansions;
  if (outcome == SearchOutcome::kStuck) {
    certificate = {};
    certificate.witness = std::move(levels.witness);
    return result;
  }
  open_blossoms(state, certificate);
  result.mate.resize(graph.n_nodes);
  for (int v = 0; v < graph.n_nodes; ++v) result.mate[v] = state.nodes[v].mate;
  return result;
}

/// Returns the largest absolute cost.
long long check(const MatchingGraph& graph) {
  if (graph.n_nodes < 0 ||
      graph.edges.size() > static_cast<std::size_t>(std::numeric_limits<int>::max()) / 2) {
    throw std::invalid_argument("matching: " + std::to_string(graph.edges.size()) + " edges are too many");
  }
  long long largest = 0;
  for (std::size_t i = 0; i < graph.edges.size(); ++i) {
    const auto& e = graph.edges[i];
    if (e.a < 0 || e.a >= graph.n_nodes || e.b < 0 || e.b >= graph.n_nodes) {
      throw std::invalid_argument("matching: edge " + std::to_string(i) + " has an end that is no node");
    }
    if (e.cost > kMaxMatchingCost || e.cost < -kMaxMatchingCost) {
      throw std::invalid_argument("matching: edge " + std::to_string(i) + " costs " + std::to_string(e.cost) +
                                  ", more than 2^60");
    }
    largest = std::max(largest, e.cost < 0 ? -e.cost : e.cost);
  }
  return largest;
}

/// Computes the cost of the matching by its dual values, which sum up to it.
void add_up(MatchingResult& result) {
  Wide sum = 0;
  for (const WideInteger& y : result.certificate.node_dual) sum += wide(y);
  for (const WideInteger& z : result.certificate.blossom_dual) sum += wide(z);
  sum /= MatchingCertificate::kUnits;
  if (sum > std::numeric_limits<long long>::max() || sum < std::numeric_limits<long long>::min()) {
    throw std::invalid_argument("matching: the cheapest matching costs more than 64 bits can hold");
  }
  result.cost = static_cast<long long>(sum);
  result.status = MatchingStatus::kOptimal;
}

class PrimalDualSolver final : public MatchingSolver {
 public:
  std::string name() const override { return "primal-dual"; }

  MatchingResult solve(const MatchingGraph& graph) const override {
    const Wide largest = Wide{MatchingCertificate::kUnits} * check(graph);
    const Wide limit = Wide{kBoundFactor} * (largest + 1) * (graph.n_nodes + Wide{1});
    std::optional<MatchingResult> result;
    if (limit <= std::numeric_limits<long long>::max() / kBoundFactor) {
      const auto most = static_cast<long long>(limit);
      result = largest <= std::numeric_limits<int>::max() ? solve_with<long long, int>(graph, most)
                                                          : solve_with<long long, long long>(graph, most);
    }
    if (!result) result = solve_with<Wide, Wide>(graph, Wide{1} << 120);
    if (!result) throw std::logic_error("matching: dual values leave 128 bits");
    if (result->certificate.witness.empty() &&
        result->mate.size() == static_cast<std::size_t>(graph.n_nodes) &&
        !(graph.n_nodes > 0 && result->mate.empty())) {
      add_up(*result);
    }
    return std::move(*result);
  }
};

}  // namespace

std::unique_ptr<MatchingSolver> make_primal_dual_solver() { return std::make_unique<PrimalDualSolver>(); }

}  // namespace delquad
