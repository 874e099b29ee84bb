// SPDX-License-Identifier: GPL-3.0-or-later
#include "delquad/matching.h"

#include <cstddef>
#include <utility>

#include "base/disjoint_sets.h"
#include "base/matching/wide.h"

namespace delquad {

namespace {

/// Nested blossoms as heavy paths, to find the innermost one around two nodes at any depth.
struct Nesting {
  std::vector<int> depth, path;  ///< path: the outermost blossom on the same heavy path
  std::vector<long long> size;   ///< in nodes
  std::vector<Wide> sum;         ///< sum of dual values of a blossom and all around it
  bool sound = false;            ///< parents come first, sizes are odd, duals are not negative
};

Nesting nest(const MatchingCertificate& c) {
  const int n = static_cast<int>(c.blossom_dual.size());
  Nesting nesting{std::vector<int>(n), std::vector<int>(n), std::vector<long long>(n), std::vector<Wide>(n)};
  if (c.blossom_parent.size() != c.blossom_dual.size()) return nesting;
  for (const int b : c.node_blossom) {
    if (b < -1 || b >= n) return nesting;
    if (b >= 0) ++nesting.size[b];
  }
  for (int b = 0; b < n; ++b) {
    if (c.blossom_parent[b] < -1 || c.blossom_parent[b] >= b) return nesting;
  }
  std::vector<int> heavy(n, -1);
  for (int b = n - 1; b >= 0; --b) {
    const int p = c.blossom_parent[b];
    if (nesting.size[b] % 2 == 0 || c.blossom_dual[b].high < 0) return nesting;
    if (p < 0) continue;
    nesting.size[p] += nesting.size[b];
    if (heavy[p] < 0 || nesting.size[b] > nesting.size[heavy[p]]) heavy[p] = b;
  }
  for (int b = 0; b < n; ++b) {
    const int p = c.blossom_parent[b];
    nesting.depth[b] = p < 0 ? 0 : nesting.depth[p] + 1;
    nesting.sum[b] = wide(c.blossom_dual[b]) + (p < 0 ? 0 : nesting.sum[p]);
    nesting.path[b] = p >= 0 && heavy[p] == b ? nesting.path[p] : b;
  }
  nesting.sound = true;
  return nesting;
}

/// Returns the dual values of the blossoms that an edge between nodes in a and in b leaves.
Wide crossed(const MatchingCertificate& c, const Nesting& nesting, int a, int b) {
  Wide sum = (a < 0 ? 0 : nesting.sum[a]) + (b < 0 ? 0 : nesting.sum[b]);
  while (a >= 0 && b >= 0 && nesting.path[a] != nesting.path[b]) {
    if (nesting.depth[nesting.path[a]] < nesting.depth[nesting.path[b]]) std::swap(a, b);
    a = c.blossom_parent[nesting.path[a]];
  }
  if (a >= 0 && b >= 0) sum -= 2 * nesting.sum[nesting.depth[a] < nesting.depth[b] ? a : b];
  return sum;
}

bool fail(std::string* why, const std::string& what) {
  if (why != nullptr) *why = what;
  return false;
}

}  // namespace

bool proves_optimal(const MatchingGraph& graph, const std::vector<int>& mate,
                    const MatchingCertificate& certificate, std::string* why) {
  const std::size_t n = graph.n_nodes;
  if (mate.size() != n) return fail(why, "not as many mates as nodes");
  if (certificate.node_dual.size() != n || certificate.node_blossom.size() != n)
    return fail(why, "no certificate");
  for (std::size_t v = 0; v < n; ++v) {
    const int m = mate[v];
    if (m < 0 || m >= graph.n_nodes || mate[m] != static_cast<int>(v) || m == static_cast<int>(v)) {
      return fail(why, "the mates are no matching");
    }
  }
  const Nesting nesting = nest(certificate);
  if (!nesting.sound) return fail(why, "a blossom is even, negative, or out of order");
  std::vector<char> seen(n, 0);
  Wide primal = 0, dual = 0;
  std::vector<long long> cost(n, 0);  // of the cheapest edge to the mate
  for (const auto& e : graph.edges) {
    if (e.a == e.b) continue;
    const Wide left =
        Wide{MatchingCertificate::kUnits} * e.cost - wide(certificate.node_dual[e.a]) -
        wide(certificate.node_dual[e.b]) -
        crossed(certificate, nesting, certificate.node_blossom[e.a], certificate.node_blossom[e.b]);
    if (left < 0) return fail(why, "an edge has negative slack");
    if (mate[e.a] != e.b) continue;
    const int v = e.a < e.b ? e.a : e.b;
    if (seen[v] == 0 || e.cost < cost[v]) cost[v] = e.cost;
    seen[v] = 1;
  }
  for (std::size_t v = 0; v < n; ++v) {
    if (mate[v] > static_cast<int>(v)) {
      if (seen[v] == 0) return fail(why, "a node is matched without an edge");
      primal += Wide{MatchingCertificate::kUnits} * cost[v];
    }
    dual += wide(certificate.node_dual[v]);
  }
  for (const WideInteger& z : certificate.blossom_dual) dual += wide(z);
  return primal == dual || fail(why, "the matching costs more than the dual values say");
}

bool proves_not_perfect(const MatchingGraph& graph, const MatchingCertificate& certificate) {
  std::vector<char> taken(graph.n_nodes, 0);
  long long n_taken = 0;
  for (const int v : certificate.witness) {
    if (v < 0 || v >= graph.n_nodes || taken[v] != 0) return false;
    taken[v] = 1;
    ++n_taken;
  }
  DisjointSets left(graph.n_nodes);
  for (const auto& e : graph.edges) {
    if (taken[e.a] == 0 && taken[e.b] == 0) left.join(e.a, e.b);
  }
  std::vector<char> odd(graph.n_nodes, 0);
  long long n_odd = 0;
  for (int v = 0; v < graph.n_nodes; ++v) {
    if (taken[v] == 0) odd[left.root(v)] ^= 1;
  }
  for (const char o : odd) n_odd += o;
  return n_odd > n_taken;
}

}  // namespace delquad
