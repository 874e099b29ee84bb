#pragma once

#include <memory>
#include <string>
#include <vector>

namespace delquad {

/// An undirected graph with integer edge costs; parallel edges and self-loops are not allowed.
struct MatchingGraph {
  struct Edge {
    int a, b;
    long long cost;  ///< >= 0
  };
  int n_nodes = 0;
  std::vector<Edge> edges;
};

enum class MatchingStatus {
  kOptimal,     ///< perfect, of minimum cost
  kNotPerfect,  ///< the graph has no perfect matching
};

struct MatchingResult {
  MatchingStatus status = MatchingStatus::kNotPerfect;
  std::vector<int> mate;  ///< node -> its partner; empty unless perfect
  long long cost = 0;
};

/// Minimum-cost perfect matching. One file a solver; nothing here knows of meshes.
class MatchingSolver {
 public:
  virtual ~MatchingSolver() = default;
  virtual std::string name() const = 0;
  virtual MatchingResult solve(const MatchingGraph& graph) const = 0;
};

/// LEMON's MaxWeightedPerfectMatching, started from the fractional solution, on a thread with a stack that is
/// large enough for its recursion over nested blossoms.
std::unique_ptr<MatchingSolver> make_lemon_solver();

}  // namespace delquad
