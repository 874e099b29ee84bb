// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/matching/matching.h"
#include "tests/support/meshing.h"

namespace delquad {
namespace {

constexpr long long kInfinite = std::numeric_limits<long long>::max();

/// Cheapest perfect matching by trying every partner of the first free node.
long long enumerate(const std::vector<std::vector<long long>>& cost, unsigned taken) {
  const int n = static_cast<int>(cost.size());
  int a = 0;
  while (a < n && (taken >> a & 1) != 0) ++a;
  if (a == n) return 0;
  long long best = kInfinite;
  for (int b = a + 1; b < n; ++b) {
    if ((taken >> b & 1) != 0 || cost[a][b] == kInfinite) continue;
    const long long rest = enumerate(cost, taken | 1u << a | 1u << b);
    if (rest != kInfinite) best = std::min(best, rest + cost[a][b]);
  }
  return best;
}

struct RandomGraph {
  MatchingGraph graph;
  std::vector<std::vector<long long>> cost;
};

RandomGraph random_graph(std::mt19937_64& random, int n, double density, long long max_cost) {
  RandomGraph r;
  r.graph.n_nodes = n;
  r.cost.assign(n, std::vector<long long>(n, kInfinite));
  for (int b = 0; b < n; ++b) {
    for (int a = 0; a < b; ++a) {
      if (static_cast<double>(random() >> 11) * 0x1p-53 > density) continue;
      const long long c = static_cast<long long>(random() % (max_cost + 1));
      r.graph.edges.push_back({a, b, c});
      r.cost[a][b] = r.cost[b][a] = c;
    }
  }
  return r;
}

/// Every solver must pass.
using MakeSolver = std::unique_ptr<MatchingSolver> (*)();
class Matching : public testing::TestWithParam<MakeSolver> {};

INSTANTIATE_TEST_SUITE_P(Solvers, Matching, testing::Values(&make_primal_dual_solver, &make_lemon_solver),
                         [](const auto& made) { return made.index == 0 ? "PrimalDual" : "Lemon"; });

TEST_P(Matching, AgreesWithEnumerationOnRandomGraphs) {
  const auto solver = GetParam()();
  std::mt19937_64 random(7);
  int perfect = 0, not_perfect = 0;
  for (int trial = 0; trial < 1500; ++trial) {
    const int n = 2 + 2 * static_cast<int>(random() % 7);
    const double density = trial % 3 == 0 ? 0.2 : trial % 3 == 1 ? 0.35 : 1.0;
    // Few values: many ties. Large values: as dear as extra edges.
    const long long max_cost = trial % 2 == 0 ? 3 : 100'000'000'000;
    const RandomGraph r = random_graph(random, n, density, max_cost);
    const long long expected = enumerate(r.cost, 0);
    const MatchingResult result = solver->solve(r.graph);
    if (expected == kInfinite) {
      ++not_perfect;
      EXPECT_EQ(result.status, MatchingStatus::kNotPerfect) << trial;
      EXPECT_TRUE(result.mate.empty());
      continue;
    }
    ++perfect;
    ASSERT_EQ(result.status, MatchingStatus::kOptimal) << trial;
    EXPECT_EQ(result.cost, expected) << trial;
    ASSERT_EQ(result.mate.size(), static_cast<std::size_t>(n));
    long long sum = 0;
    for (int a = 0; a < n; ++a) {
      const int b = result.mate[a];
      ASSERT_TRUE(b >= 0 && b < n && b != a && result.mate[b] == a && r.cost[a][b] != kInfinite) << trial;
      if (a < b) sum += r.cost[a][b];
    }
    EXPECT_EQ(sum, expected) << trial;
  }
  EXPECT_GT(perfect, 500);
  EXPECT_GT(not_perfect, 100);
}

TEST_P(Matching, EmptyGraphIsMatchedAndOddOrIsolatedNodesAreNot) {
  const auto solver = GetParam()();
  EXPECT_EQ(solver->solve({}).status, MatchingStatus::kOptimal);
  EXPECT_EQ(solver->solve({1, {}}).status, MatchingStatus::kNotPerfect);
  EXPECT_EQ(solver->solve({2, {}}).status, MatchingStatus::kNotPerfect);
  EXPECT_EQ(solver->solve({3, {{0, 1, 1}, {1, 2, 1}, {2, 0, 1}}}).status, MatchingStatus::kNotPerfect);
  // Two triangles joined by nothing: each is odd.
  EXPECT_EQ(solver->solve({6, {{0, 1, 1}, {1, 2, 1}, {2, 0, 1}, {3, 4, 1}, {4, 5, 1}, {5, 3, 1}}}).status,
            MatchingStatus::kNotPerfect);
}

TEST_P(Matching, OddCyclesMustBeLeftByTheDearBridge) {
  // Two triangles joined by one dear edge: it is the only way.
  const MatchingGraph graph = {
      6, {{0, 1, 5}, {1, 2, 7}, {2, 0, 9}, {3, 4, 1}, {4, 5, 2}, {5, 3, 3}, {2, 3, 1'000'000'000'000}}};
  const MatchingResult result = GetParam()()->solve(graph);
  ASSERT_EQ(result.status, MatchingStatus::kOptimal);
  EXPECT_EQ(result.mate, (std::vector<int>{1, 0, 3, 2, 5, 4}));
  EXPECT_EQ(result.cost, 1'000'000'000'007);
}

TEST_P(Matching, TheSameGraphGivesTheSameMatching) {
  std::mt19937_64 random(3);
  const RandomGraph r = random_graph(random, 200, 0.1, 2);  // full of ties
  const MatchingResult first = GetParam()()->solve(r.graph);
  ASSERT_EQ(first.status, MatchingStatus::kOptimal);
  for (int k = 0; k < 5; ++k) EXPECT_EQ(GetParam()()->solve(r.graph).mate, first.mate);
}

}  // namespace
}  // namespace delquad
