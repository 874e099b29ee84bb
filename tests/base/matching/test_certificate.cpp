// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/matching/matching.h"
#include "base/matching/wide.h"
#include "delquad/matching.h"
#include "tests/base/matching/graph_kinds.h"
#include "tests/support/meshing.h"

namespace delquad {
namespace {

/// Two triangles, joined by a dear edge and by two that are dearer still: both become blossoms.
MatchingGraph two_triangles() {
  return {6,
          {{0, 1, 10},
           {1, 2, 10},
           {2, 0, 10},
           {3, 4, 10},
           {4, 5, 10},
           {5, 3, 10},
           {2, 3, 100},
           {0, 4, 140},
           {1, 5, 150}}};
}

void add(WideInteger& number, Wide by) { number = narrow(wide(number) + by); }

TEST(Certificate, HandMadeProofIsTaken) {
  // Cost 120. Nodes 5 each, blossoms 45 each: 2-3 has slack 100 - 10 - 90.
  MatchingCertificate c;
  c.node_dual.assign(6, 4 * 5);
  c.blossom_dual = {4 * 45, 4 * 45};
  c.blossom_parent = {-1, -1};
  c.node_blossom = {0, 0, 0, 1, 1, 1};
  const std::vector<int> mate = {1, 0, 3, 2, 5, 4};
  std::string why;
  EXPECT_TRUE(proves_optimal(two_triangles(), mate, c, &why)) << why;

  auto bad = c;
  add(bad.blossom_dual[0], 1);
  EXPECT_FALSE(proves_optimal(two_triangles(), mate, bad, &why));
  EXPECT_EQ(why, "an edge has negative slack");
  bad = c;
  add(bad.blossom_dual[0], -1);
  EXPECT_FALSE(proves_optimal(two_triangles(), mate, bad, &why));
  EXPECT_EQ(why, "the matching costs more than the dual values say");
  bad = c;
  bad.blossom_dual = {4 * 95, -4 * 5};
  EXPECT_FALSE(proves_optimal(two_triangles(), mate, bad, &why));
  bad = c;
  bad.node_blossom = {0, 0, -1, 1, 1, 1};  // an even blossom
  EXPECT_FALSE(proves_optimal(two_triangles(), mate, bad, &why));
  bad = c;
  bad.blossom_parent = {1, 0};  // around each other
  EXPECT_FALSE(proves_optimal(two_triangles(), mate, bad, &why));
  EXPECT_EQ(why, "a blossom is even, negative, or out of order");
  bad = c;
  bad.node_blossom[3] = 2;
  EXPECT_FALSE(proves_optimal(two_triangles(), mate, bad, &why));
  bad = c;
  bad.node_dual.pop_back();
  EXPECT_FALSE(proves_optimal(two_triangles(), mate, bad, &why));

  // Matchings that are none, or cost more.
  EXPECT_FALSE(proves_optimal(two_triangles(), {1, 0, 3, 2, 5, 5}, c));
  EXPECT_FALSE(proves_optimal(two_triangles(), {1, 0, 3, 2}, c));
  EXPECT_FALSE(proves_optimal(two_triangles(), {3, 2, 1, 0, 5, 4}, c, &why));
  EXPECT_EQ(why, "a node is matched without an edge");
  EXPECT_FALSE(proves_optimal(two_triangles(), {4, 2, 1, 5, 0, 3}, c, &why));
  EXPECT_EQ(why, "the matching costs more than the dual values say");
}

TEST(Certificate, AnyChangeOfAProofIsNoticed) {
  Random random(9);
  int changes = 0;
  for (int trial = 0; trial < 300; ++trial) {
    MatchingGraph graph = cubic_graph(random, 40);
    price(graph, random, 1000);
    const MatchingResult result = make_primal_dual_solver()->solve(graph);
    ASSERT_TRUE(proves_optimal(graph, result.mate, result.certificate));
    const int v = below(random, graph.n_nodes);
    auto bad = result.certificate;
    add(bad.node_dual[v], 1);
    EXPECT_FALSE(proves_optimal(graph, result.mate, bad));
    add(bad.node_dual[v], -2);
    EXPECT_FALSE(proves_optimal(graph, result.mate, bad));
    for (std::size_t b = 0; b < result.certificate.blossom_dual.size(); ++b, ++changes) {
      bad = result.certificate;
      add(bad.blossom_dual[b], b % 2 == 0 ? 1 : -1);
      EXPECT_FALSE(proves_optimal(graph, result.mate, bad));
    }
  }
  EXPECT_GT(changes, 100);
}

TEST(Certificate, SumsBeyondSixtyFourBitsAreExact) {
  // Forty edges of 2^60: the sum is 40 * 2^60, and modulo 2^64 it would be 8 * 2^60.
  MatchingGraph graph{80, {}};
  MatchingCertificate c;
  std::vector<int> mate;
  for (int v = 0; v < 80; v += 2) {
    graph.edges.push_back({v, v + 1, 1LL << 60});
    mate.insert(mate.end(), {v + 1, v});
  }
  c.node_dual.assign(80, narrow(Wide{1} << 61));
  c.node_blossom.assign(80, -1);
  EXPECT_TRUE(proves_optimal(graph, mate, c));
  add(c.node_dual[0], -(Wide{1} << 64));
  EXPECT_FALSE(proves_optimal(graph, mate, c));
}

TEST(Certificate, WitnessesAreChecked) {
  const MatchingGraph star{4, {{0, 1, 1}, {0, 2, 1}, {0, 3, 1}}};
  MatchingCertificate c;
  c.witness = {0};
  EXPECT_TRUE(proves_not_perfect(star, c));
  c.witness = {};
  EXPECT_FALSE(proves_not_perfect(star, c));
  c.witness = {1};
  EXPECT_FALSE(proves_not_perfect(star, c));
  c.witness = {0, 0};
  EXPECT_FALSE(proves_not_perfect(star, c));
  c.witness = {4};
  EXPECT_FALSE(proves_not_perfect(star, c));
  c.witness = {0};
  EXPECT_FALSE(proves_not_perfect({4, {{0, 1, 1}, {2, 3, 1}}}, c));
}

}  // namespace
}  // namespace delquad
