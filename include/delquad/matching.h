#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "delquad/options.h"

// Perfect matching of minimum cost: what makes quads of triangles, and counts on curves even. Valid C++17.

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

/// An integer of 128 bits, as two's complement: `low` has all of it where `high` is 0, or -1 for negative
/// ones.
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
/// Blossoms are odd sets of nodes, nested or apart; a blossom comes after the one around it. An edge's slack
/// is its cost less the dual values of its ends and of all blossoms that it leaves. If no slack and no
/// blossom's dual value is negative, no perfect matching costs less than the sum of all dual values.
struct MatchingCertificate {
  static constexpr int kUnits = 4;  ///< dual values count quarters of the unit of costs
  std::vector<WideInteger> node_dual;
  std::vector<int> node_blossom;  ///< the innermost one around a node; -1: none
  std::vector<WideInteger> blossom_dual;
  std::vector<int> blossom_parent;  ///< the next one around it; -1: none
  /// Nodes without which the graph has more components of an odd number of nodes than these are.
  std::vector<int> witness;
};

/// Whether the mates are a perfect matching and the certificate proves that none is cheaper, by exact
/// arithmetic that shares nothing with a solver. Else `why` says what is wrong.
bool proves_optimal(const MatchingGraph& graph, const std::vector<int>& mate,
                    const MatchingCertificate& certificate, std::string* why = nullptr);

/// Whether the witness proves that the graph has no perfect matching [tutte1947].
bool proves_not_perfect(const MatchingGraph& graph, const MatchingCertificate& certificate);

enum class MatchingStatus {
  kOptimal,     ///< perfect, of minimum cost
  kNotPerfect,  ///< the graph has no perfect matching
};

struct MatchingResult {
  MatchingStatus status = MatchingStatus::kNotPerfect;
  std::vector<int> mate = {};  ///< node -> its partner; empty unless perfect
  long long cost = 0;
  /// Why no matching is cheaper, or why none is perfect. Empty where the solver has no proof.
  MatchingCertificate certificate = {};
  long long contractions = 0, expansions = 0;  ///< of blossoms, where the solver counts them
  /// What else the solver has to say, for the step "recombination" of records.
  std::vector<SummaryField> fields = {};
};

/// Minimum-cost perfect matching. One file a solver; nothing here knows of meshes.
class MatchingSolver {
 public:
  virtual ~MatchingSolver() = default;
  virtual std::string name() const = 0;
  virtual MatchingResult solve(const MatchingGraph& graph) const = 0;
};

/// Solvers may be made, and asked, in several threads at once.
using MatchingSolverFactory = std::function<std::unique_ptr<MatchingSolver>(const Options&)>;

/// Adds one from outside, before anything is read or meshed: what `recombination.solver` may be. Throws
/// std::invalid_argument for a name that is taken or empty.
void add_matching_solver(const std::string& name, MatchingSolverFactory factory);
/// The solver of that name; what it returns is checked: a result that is no perfect matching of the graph is
/// an Error that names the solver. Throws InputError, naming those known.
std::unique_ptr<MatchingSolver> matching_solver(const std::string& name, const Options& options = {});
/// The project's own first.
std::vector<std::string> matching_solver_names();

}  // namespace delquad
