// SPDX-License-Identifier: GPL-3.0-or-later
#include <sys/resource.h>
#include <unistd.h>
#include <new>
#include <stop_token>
#include "base/matching/matching.h"
#include "tests/base/matching/graph_kinds.h"
#include "tests/support/meshing.h"
#include "tests/support/needs_file.h"

namespace delquad {
namespace {

/// LEMON takes neither parallel edges nor loops: the cheapest of each kind is left.
MatchingGraph simple(const MatchingGraph& graph) {
  MatchingGraph out{graph.n_nodes, graph.edges};
  for (auto& e : out.edges) {
    if (e.a > e.b) std::swap(e.a, e.b);
  }
  const auto key = [](const auto& e) { return std::tuple(e.a, e.b, e.cost); };
  std::sort(out.edges.begin(), out.edges.end(),
            [&](const auto& x, const auto& y) { return key(x) < key(y); });
  const auto same = [](const auto& x, const auto& y) { return x.a == y.a && x.b == y.b; };
  out.edges.erase(std::unique(out.edges.begin(), out.edges.end(), same), out.edges.end());
  std::erase_if(out.edges, [](const auto& e) { return e.a == e.b; });
  return out;
}

struct Tally {
  int perfect = 0, not_perfect = 0;
  long long contractions = 0, expansions = 0;
};

/// Solves and checks the proof; and LEMON says the same where asked.
void solve(const MatchingGraph& graph, Tally& tally, bool ask_lemon = true) {
  const MatchingResult result = make_primal_dual_solver()->solve(graph);
  tally.contractions += result.contractions;
  tally.expansions += result.expansions;
  if (result.status == MatchingStatus::kOptimal) {
    ++tally.perfect;
    std::string why;
    ASSERT_TRUE(proves_optimal(graph, result.mate, result.certificate, &why)) << why;
  } else {
    ++tally.not_perfect;
    EXPECT_TRUE(result.mate.empty());
    ASSERT_TRUE(proves_not_perfect(graph, result.certificate));
  }
  if (!ask_lemon) return;
  const MatchingResult reference = make_lemon_solver()->solve(simple(graph));
  ASSERT_EQ(result.status, reference.status);
  ASSERT_EQ(result.cost, reference.cost);
}

Tally solve_many(int trials, const std::function<MatchingGraph(Random&)>& make) {
  Tally tally;
  Random random(11);
  constexpr long long kLargest[] = {1, 3, 20, 1'000'000, 100'000'000'000};
  for (int trial = 0; trial < trials && !testing::Test::HasFatalFailure(); ++trial) {
    MatchingGraph graph = make(random);
    price(graph, random, kLargest[trial % std::size(kLargest)]);
    SCOPED_TRACE(trial);
    solve(graph, tally);
  }
  return tally;
}

TEST(PrimalDual, AgreesWithLemonOnSparseGraphs) {
  const Tally tally = solve_many(12000, [](Random& random) {
    return sparse_graph(random, 2 * (1 + below(random, 20)), 2 + below(random, 5));
  });
  EXPECT_GT(tally.perfect, 2000);
  EXPECT_GT(tally.not_perfect, 2000);
}

TEST(PrimalDual, AgreesWithLemonOnCompleteGraphs) {
  const Tally tally =
      solve_many(3000, [](Random& random) { return complete_graph(2 + 2 * below(random, 14)); });
  EXPECT_EQ(tally.perfect, 3000);
}

TEST(PrimalDual, AgreesWithLemonOnOddCyclesLinkedByBridges) {
  const Tally tally =
      solve_many(4000, [](Random& random) { return linked_cycles(random, 2 + below(random, 30)); });
  EXPECT_GT(tally.perfect, 300);
  EXPECT_GT(tally.not_perfect, 300);
  EXPECT_GT(tally.expansions, 1500);
}

TEST(PrimalDual, AgreesWithLemonOnCubicGraphsWithParallelEdges) {
  const Tally tally =
      solve_many(6000, [](Random& random) { return cubic_graph(random, 2 + 2 * below(random, 60)); });
  EXPECT_EQ(tally.perfect, 6000);
}

TEST(PrimalDual, AgreesWithLemonOnGraphsOfManyRanges) {
  // Larger than the smallest ranges, in an order in which edges lead anywhere or nearby only.
  Tally tally;
  Random random(5);
  for (int trial = 0; trial < 6; ++trial) {
    MatchingGraph graph = cubic_graph(random, 30000);
    if (trial % 2 == 0) {
      for (auto& e : graph.edges) e.b = std::min(graph.n_nodes - 1, e.a + 1 + std::abs(e.b - e.a) % 40);
      for (int v = 0; v < graph.n_nodes; v += 2) graph.edges.push_back({v, v + 1, 0});
      std::erase_if(graph.edges, [](const auto& e) { return e.a == e.b; });
    }
    price(graph, random, trial < 3 ? 3 : 1'000'000);
    solve(graph, tally);
  }
  EXPECT_EQ(tally.perfect, 6);
  EXPECT_GT(tally.expansions, 1000);
}

TEST(PrimalDual, LatticesWithTiesAndWithNearTies) {
  Tally tally;
  Random random(2);
  for (const int noise : {0, 1, 100, 10000}) {
    MatchingGraph graph = triangle_lattice(100, 333333, 100'000'000);
    for (auto& e : graph.edges) e.cost += noise > 0 ? below(random, noise + 1) : 0;
    solve(graph, tally);
  }
  EXPECT_EQ(tally.perfect, 4);
  EXPECT_GT(tally.expansions, 50);
}

TEST(PrimalDual, OneNodeBesideAllOthers) {
  // As where a component has an odd number of triangles.
  Tally tally;
  MatchingGraph graph = triangle_lattice(61, 333333, 100'000'000);
  Random random(3);
  for (auto& e : graph.edges) e.cost += below(random, 300000);
  ASSERT_EQ(graph.n_nodes % 2, 1);
  for (int v = 0; v < graph.n_nodes; ++v) graph.edges.push_back({v, graph.n_nodes, 0});
  ++graph.n_nodes;
  solve(graph, tally);
  EXPECT_EQ(tally.perfect, 1);
}

TEST(PrimalDual, CostsOfBothSignsNearTheLimit) {
  Tally tally;
  Random random(4);
  for (int trial = 0; trial < 300; ++trial) {
    MatchingGraph graph = trial % 2 == 0 ? complete_graph(12) : cubic_graph(random, 12);
    for (auto& e : graph.edges) {
      e.cost = static_cast<long long>(random() % (2ULL * kMaxMatchingCost + 1)) - kMaxMatchingCost;
      if (trial % 3 == 0) e.cost = e.cost > 0 ? kMaxMatchingCost : -kMaxMatchingCost;
    }
    solve(graph, tally, false);
  }
  EXPECT_EQ(tally.perfect, 300);
}

TEST(PrimalDual, CostsAndNodesThatAreNotAllowedAreRefused) {
  const auto solver = make_primal_dual_solver();
  EXPECT_THROW(solver->solve({2, {{0, 1, kMaxMatchingCost + 1}}}), std::invalid_argument);
  EXPECT_THROW(solver->solve({2, {{0, 1, std::numeric_limits<long long>::min()}}}), std::invalid_argument);
  EXPECT_THROW(solver->solve({2, {{0, 2, 1}}}), std::invalid_argument);
  EXPECT_THROW(solver->solve({2, {{-1, 1, 1}}}), std::invalid_argument);
  MatchingGraph many{40, {}};
  for (int v = 0; v < 40; v += 2) many.edges.push_back({v, v + 1, kMaxMatchingCost});
  EXPECT_THROW(solver->solve(many), std::invalid_argument);
}

TEST(PrimalDual, WitnessesWhereThereIsNoPerfectMatching) {
  Tally tally;
  solve({1, {}}, tally);
  solve({2, {}}, tally);
  solve({2, {{0, 0, 1}}}, tally);
  solve({3, {{0, 1, 1}, {1, 2, 1}, {2, 0, 1}}}, tally);
  solve({6, {{0, 1, 1}, {1, 2, 1}, {2, 0, 1}, {3, 4, 1}, {4, 5, 1}, {5, 3, 1}}}, tally);
  // Three odd cycles around one node: whichever it is matched with, two are left.
  MatchingGraph flower{10, {}};
  for (int k = 0; k < 3; ++k) {
    for (int i = 0; i < 3; ++i) flower.edges.push_back({1 + 3 * k + i, 1 + 3 * k + (i + 1) % 3, 5 + i});
    flower.edges.push_back({0, 1 + 3 * k, 2});
  }
  solve(flower, tally);
  // A star, and a good part beside it.
  solve({6, {{0, 1, 1}, {0, 2, 2}, {0, 3, 3}, {4, 5, 1}}}, tally);
  EXPECT_EQ(tally.not_perfect, 7);
  solve({}, tally);
  solve({2, {{0, 0, 1}, {0, 1, 9}, {1, 0, 7}, {1, 1, -5}}}, tally);
  EXPECT_EQ(tally.perfect, 2);
}

TEST(PrimalDual, WitnessesInGraphsOfManyRanges) {
  // Four triangles hang at one node: at most one of them is matched with it.
  Random random(12);
  MatchingGraph graph = cubic_graph(random, 60'000);
  for (int k = 0; k < 4; ++k) {
    const int first = graph.n_nodes;
    graph.n_nodes += 3;
    for (int i = 0; i < 3; ++i) graph.edges.push_back({first + i, first + (i + 1) % 3, 0});
    graph.edges.push_back({first, 30'000, 0});
  }
  price(graph, random, 1000);
  on_threads({1, 2, 7}, [&] {
    const MatchingResult result = make_primal_dual_solver()->solve(graph);
    EXPECT_EQ(result.status, MatchingStatus::kNotPerfect);
    EXPECT_TRUE(proves_not_perfect(graph, result.certificate));
    return result.certificate.witness;
  });
}

TEST(PrimalDual, BlossomsNestedDeeply) {
  // Two centers, each of which reaches pair after pair that close triangles with all that it has, before it
  // reaches the other one.
  constexpr int kPairs = 100'000, kHalf = 2 * kPairs + 1;
  MatchingGraph graph{2 * kHalf, {}};
  for (int centre = 0; centre < graph.n_nodes; centre += kHalf) {
    for (int k = 0; k < kPairs; ++k) {
      const int p = centre + 2 * k + 1;
      graph.edges.push_back({p, p + 1, 0});
      graph.edges.push_back({centre, p, 8LL * (k + 1)});
      graph.edges.push_back({centre, p + 1, 8LL * (k + 1)});
    }
  }
  graph.edges.push_back({0, kHalf, 32LL * kPairs});
  const MatchingResult result = make_primal_dual_solver()->solve(graph);
  ASSERT_EQ(result.status, MatchingStatus::kOptimal);
  EXPECT_EQ(result.cost, 32LL * kPairs);
  std::string why;
  EXPECT_TRUE(proves_optimal(graph, result.mate, result.certificate, &why)) << why;
  std::vector<int> depth = {0};
  for (const int parent : result.certificate.blossom_parent) {
    depth.push_back(parent < 0 ? 1 : depth[static_cast<std::size_t>(parent) + 1] + 1);
  }
  EXPECT_GE(*std::max_element(depth.begin(), depth.end()), kPairs - 1);
}

TEST(PrimalDual, TheSameGraphGivesTheSameMatching) {
  Random random(8);
  MatchingGraph graph = cubic_graph(random, 20000);
  price(graph, random, 2);  // full of ties
  const MatchingResult first = make_primal_dual_solver()->solve(graph);
  ASSERT_EQ(first.status, MatchingStatus::kOptimal);
  for (int k = 0; k < 3; ++k) EXPECT_EQ(make_primal_dual_solver()->solve(graph).mate, first.mate);
}

/// Graphs of many ranges on all levels. In the second all costs tie. The third has an odd number of
/// triangles, one of which is left to a node that all others know.
TEST(PrimalDual, EveryNumberOfThreadsGivesTheSameMatching) {
  Random random(10);
  std::vector<MatchingGraph> graphs = {cubic_graph(random, 60'000), triangle_lattice(200, 7, 1000),
                                       triangle_lattice(201, 7, 1000)};
  price(graphs[0], random, 1000);
  const int spare = graphs[2].n_nodes++;
  for (int v = 0; v < spare; ++v) graphs[2].edges.push_back({v, spare, 0});
  for (const MatchingGraph& graph : graphs) {
    MatchingResult result;
    on_threads({1, 2, 3, 7}, [&] {
      result = make_primal_dual_solver()->solve(graph);
      const MatchingCertificate& proof = result.certificate;
      return std::tuple(result.mate, proof.node_dual, proof.blossom_parent, result.contractions);
    });
    std::string why;
    ASSERT_TRUE(proves_optimal(graph, result.mate, result.certificate, &why)) << why;
  }
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // they take terabytes of addresses
long long address_space() {
  long long pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * sysconf(_SC_PAGESIZE);
}

/// Ends the process with 7 when memory runs out, as with many nodes on a small machine.
[[noreturn]] void solve_within(const MatchingGraph& graph, long long bytes) {
  const RunScope run({.threads = 1});
  const rlim_t most = static_cast<rlim_t>(address_space() + bytes);
  const rlimit limit = {most, most};
  setrlimit(RLIMIT_AS, &limit);
  try {
    make_primal_dual_solver()->solve(graph);
  } catch (const std::bad_alloc&) {
    _exit(7);
  }
  _exit(0);
}

TEST(PrimalDual, TooLittleMemoryIsAnException) {
  NEEDS_FILE("/proc/self/statm");
  GTEST_FLAG_SET(death_test_style, "threadsafe");  // without the memory that other tests have left free
  Random random(13);
  MatchingGraph graph = cubic_graph(random, 200'000);
  price(graph, random, 1'000'000);
  for (const long long megabytes : {1, 2, 4, 8, 16, 20}) {
    SCOPED_TRACE(megabytes);
    EXPECT_EXIT(solve_within(graph, megabytes << 20), testing::ExitedWithCode(7), "");
  }
  EXPECT_EXIT(solve_within(graph, 4LL << 30), testing::ExitedWithCode(0), "");
}
#endif

TEST(PrimalDual, IsCancelledAtAnyCheck) {
  Random random(9);
  MatchingGraph graph = cubic_graph(random, 100'000);
  price(graph, random, 1'000'000);
  long long all = 0;
  {
    const RunScope run({.threads = 1, .on_check = [&] { ++all; }});
    make_primal_dual_solver()->solve(graph);
  }
  ASSERT_GT(all, 15);  // some milliseconds lie between two of them
  for (long long at = 1; at <= all; at += all / 10) {
    SCOPED_TRACE(at);
    std::stop_source stop;
    long long checks = 0;
    const RunScope run({.threads = 1, .cancel = stop.get_token(), .on_check = [&] {
                          if (++checks == at) stop.request_stop();
                        }});
    EXPECT_THROW(make_primal_dual_solver()->solve(graph), Cancelled);
    EXPECT_EQ(checks, at);
  }
}

}  // namespace
}  // namespace delquad
