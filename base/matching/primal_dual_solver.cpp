#include <algorithm>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "base/cancel.h"
#include "base/matching/matching.h"
#include "base/matching/primal_dual_levels.h"
#include "base/matching/primal_dual_start.h"
#include "base/matching/primal_dual_state.h"

namespace delquad {

namespace {

/// Times and dual values are, with all else that is added to them, at most this many times a bound on the sum
/// of the costs of a matching (docs/matching.md).
constexpr int kRoom = 16;

/// Opens all blossoms from outside to inside, noting them down.
template <class Value, class Cost>
void open_blossoms(PrimalDualState<Value, Cost>& state, MatchingCertificate& certificate) {
  struct Open {
    int container, parent;
    Value around;  ///< dual values of all blossoms around it
  };
  std::vector<Open> left;
  for (int v = state.n_nodes - 1; v >= 0; --v) {
    certificate.node_dual[v] = state.nodes[v].value + state.nodes[state.nodes[v].container].offset;
    if (state.nodes[v].container == v && state.nodes[v].blossom >= 0) left.push_back({v, -1, 0});
  }
  for (unsigned opened = 0; !left.empty(); ++opened) {
    if (opened % kPerCheck == 0) check_cancelled();
    const Open open = left.back();
    left.pop_back();
    const auto& node = state.nodes[open.container];
    const Value dual = node.offset - state.blossoms[node.blossom].origin;
    const int b = static_cast<int>(certificate.blossom_dual.size());
    certificate.blossom_dual.push_back(dual);
    certificate.blossom_parent.push_back(open.parent);
    const Value around = open.around + dual;
    for (const auto& child : state.expand(open.container, node.offset)) {
      if (child.blossom >= 0) {
        left.push_back({child.container, b, around});
      } else {
        certificate.node_blossom[child.container] = b;
        certificate.node_dual[child.container] -= around;
      }
    }
  }
}

/// Nothing where the numbers are too narrow.
template <class Value, class Cost>
std::optional<MatchingResult> solve_with(const MatchingGraph& graph, Value time_limit) {
  MatchingResult result;
  MatchingCertificate& certificate = result.certificate;
  FirstMatching<Value> first = first_matching<Value>(graph);
  certificate.node_blossom.assign(graph.n_nodes, -1);
  if (first.n_free == 0) {
    result.mate = std::move(first.mate);
    certificate.node_dual.assign(first.dual.begin(), first.dual.end());
    return result;
  }
  PrimalDualState<Value, Cost> state(graph.n_nodes);
  fill_state(graph, first, state);
  first = {};
  check_cancelled();
  raise_free_nodes(state);
  PrimalDualLevels<Value, Cost> levels(state, time_limit);
  // Totals are even up to here, and costs multiples of four: two even nodes meet after a whole number of
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
  certificate.node_dual.resize(graph.n_nodes);
  open_blossoms(state, certificate);
  result.mate.resize(graph.n_nodes);
  for (int v = 0; v < graph.n_nodes; ++v) result.mate[v] = state.nodes[v].mate;
  return result;
}

/// The largest absolute cost.
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

/// The cost of the matching by its dual values, which are equal.
void add_up(MatchingResult& result) {
  WideInteger sum = 0;
  for (const WideInteger y : result.certificate.node_dual) sum += y;
  for (const WideInteger z : result.certificate.blossom_dual) sum += z;
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
    const WideInteger largest = WideInteger{MatchingCertificate::kUnits} * check(graph);
    const WideInteger limit = WideInteger{kRoom} * (largest + 1) * (graph.n_nodes + WideInteger{1});
    std::optional<MatchingResult> result;
    if (limit <= std::numeric_limits<long long>::max() / kRoom) {
      const auto narrow = static_cast<long long>(limit);
      result = largest <= std::numeric_limits<int>::max() ? solve_with<long long, int>(graph, narrow)
                                                          : solve_with<long long, long long>(graph, narrow);
    }
    if (!result) result = solve_with<WideInteger, WideInteger>(graph, WideInteger{1} << 120);
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
