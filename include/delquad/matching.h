// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "delquad/options.h"

// This header has perfect matching of minimum cost. Recombination, even counts on curves and added solvers
// use it. It is valid C++17.

namespace delquad {

/// An undirected graph with integer edge costs.
struct MatchingGraph {
  struct Edge {
    int a, b;
    long long cost;
  };
  int n_nodes = 0;
  std::vector<Edge> edges;
};

/// Integer of 128 bits, as two's complement. `low` holds a number whose `high` is 0, or -1 if it is negative.
struct WideInteger {
  std::uint64_t low = 0;
  std::int64_t high = 0;
  WideInteger() = default;
  WideInteger(long long i) : low(static_cast<std::uint64_t>(i)), high(i < 0 ? -1 : 0) {}
  WideInteger(std::int64_t high_, std::uint64_t low_) : low(low_), high(high_) {}
  bool operator==(const WideInteger& other) const { return low == other.low && high == other.high; }
};

/// A solution of the dual problem (docs/matching.md), or a witness that there is no perfect matching.
///
/// Blossoms are odd sets of nodes, nested or disjoint; an outer blossom precedes its inner ones. The slack of
/// an edge is its cost minus the duals of its ends and of all blossoms that it leaves. If no slack and no
/// blossom dual is negative, no perfect matching costs less than the sum of all duals.
struct MatchingCertificate {
  static constexpr int kUnits = 4;  ///< dual values count quarters of the unit of costs
  std::vector<WideInteger> node_dual;
  std::vector<int> node_blossom;  ///< innermost blossom around a node; -1: none
  std::vector<WideInteger> blossom_dual;
  std::vector<int> blossom_parent;  ///< next blossom around it; -1: none
  /// Set of nodes; without it the graph has more components of odd size than the set has nodes.
  std::vector<int> witness;
};

/// Returns whether the mates are a perfect matching and the certificate proves that none is cheaper. The
/// exact arithmetic shares nothing with a solver. A failure is explained in `why`, unless it is null.
bool proves_optimal(const MatchingGraph& graph, const std::vector<int>& mate,
                    const MatchingCertificate& certificate, std::string* why = nullptr);

/// Returns whether the witness proves that the graph has no perfect matching [tutte1947].
bool proves_not_perfect(const MatchingGraph& graph, const MatchingCertificate& certificate);

enum class MatchingStatus {
  kOptimal,     ///< perfect, of minimum cost
  kNotPerfect,  ///< the graph has no perfect matching
};

struct MatchingResult {
  MatchingStatus status = MatchingStatus::kNotPerfect;
  std::vector<int> mate = {};  ///< partner of each node; empty unless perfect
  long long cost = 0;
  /// Proof that no matching is cheaper, or that none is perfect. Empty if the solver has no proof.
  MatchingCertificate certificate = {};
  long long contractions = 0, expansions = 0;  ///< number of blossoms, if the solver counts them
  /// More values of the solver, for the step "recombination" of records.
  std::vector<SummaryField> fields = {};
};

/// A solver of minimum-cost perfect matching. Each has its own file and knows nothing of meshes.
class MatchingSolver {
 public:
  virtual ~MatchingSolver() = default;
  virtual std::string name() const = 0;
  /// Returns a perfect matching of minimum cost, or kNotPerfect.
  virtual MatchingResult solve(const MatchingGraph& graph) const = 0;
};

/// Makes a solver. Several threads make and ask solvers at once.
using MatchingSolverFactory = std::function<std::unique_ptr<MatchingSolver>(const Options&)>;

/// Adds a value of `recombination.solver`, before anything is read or meshed. Throws std::invalid_argument
/// for a name that is taken or empty.
void add_matching_solver(const std::string& name, MatchingSolverFactory factory);
/// Returns the solver of a name, with a check of its results. A result that is no perfect matching is an
/// Error that names the solver. Throws InputError, with all known names, for an unknown name.
std::unique_ptr<MatchingSolver> matching_solver(const std::string& name, const Options& options = {});
/// Returns the names of solvers, built-in ones first.
std::vector<std::string> matching_solver_names();

}  // namespace delquad
