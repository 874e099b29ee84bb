// SPDX-License-Identifier: GPL-3.0-or-later
#include "algorithms/recombination/dual_graph.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

#include "base/box.h"
#include "base/cancel.h"
#include "base/disjoint_sets.h"
#include "base/hilbert_place.h"
#include "base/parallel.h"
#include "base/parallel_collect.h"
#include "base/parallel_each.h"
#include "geometry/mesh/quad_corners.h"
#include "geometry/mesh/tri_topology.h"

namespace delquad {

namespace {

constexpr int kBits = 16;  // bits of each coordinate

/// Sorts by the upper 32 bits and keeps the order of equal ones. Parts of fixed length are counted and moved
/// in parallel.
void sort_by_upper_half(std::vector<std::uint64_t>& keys) {
  constexpr int kDigit = 11;
  constexpr std::size_t kPart = std::size_t{1} << 17;
  using Counts = std::array<std::size_t, 1u << kDigit>;
  std::vector<std::uint64_t> sorted(keys.size());
  std::vector<Counts> parts((keys.size() + kPart - 1) / kPart);
  for (int shift = 32; shift < 64; shift += kDigit) {
    const auto digit = [&](std::uint64_t key) { return (key >> shift) & ((1u << kDigit) - 1); };
    const auto part_of = [&](std::size_t part) {
      return std::span(keys).subspan(part * kPart, std::min(kPart, keys.size() - part * kPart));
    };
    parallel_for(parts.size(), [&](std::size_t part) {
      parts[part].fill(0);
      for (const std::uint64_t key : part_of(part)) ++parts[part][digit(key)];
    });
    std::size_t place = 0;
    for (std::size_t d = 0; d < parts[0].size(); ++d) {
      for (Counts& counts : parts) place += std::exchange(counts[d], place);
    }
    parallel_for(parts.size(), [&](std::size_t part) {
      for (const std::uint64_t key : part_of(part)) sorted[parts[part][digit(key)]++] = key;
    });
    keys.swap(sorted);
  }
}

}  // namespace

std::vector<int> hilbert_order(std::span<const Vec2> points) {
  if (points.empty()) return {};
  const auto [low, high] = Box<Vec2>::around(points);
  const double extent = std::max(high.x - low.x, high.y - low.y);
  const double scale = extent > 0 ? ((1 << kBits) - 1) / extent : 0;
  // Keys have the position in the upper half and the index in the lower half.
  std::vector<std::uint64_t> keys(points.size());
  parallel_each(points.size(), [&](std::size_t i) {
    const Vec2 p = scale * (points[i] - low);
    const std::uint32_t at = hilbert_place(static_cast<std::uint32_t>(p.x), static_cast<std::uint32_t>(p.y));
    keys[i] = std::uint64_t{at} << 32 | i;
  });
  sort_by_upper_half(keys);
  std::vector<int> order(points.size());
  parallel_each(points.size(), [&](std::size_t i) { order[i] = static_cast<int>(keys[i] & 0xffffffffu); });
  return order;
}

namespace {

std::vector<int> triangles_along_curve(const TriPatch& tri) {
  std::vector<Vec2> centroids(tri.triangles.size());
  parallel_each(centroids.size(), [&](std::size_t t) {
    const auto& v = tri.triangles[t];
    centroids[t] = (1.0 / 3) * (tri.points[v[0]] + tri.points[v[1]] + tri.points[v[2]]);
  });
  return hilbert_order(centroids);
}

long long merge_cost(const TriPatch& tri, const std::array<int, 4>& quad) {
  const auto& p = tri.points;
  const double eta = signed_eta(p[quad[0]], p[quad[1]], p[quad[2]], p[quad[3]]);
  return static_cast<long long>(std::floor(kCostUnit * (1 - eta)));
}

/// Nodes whose sides are listed together, and nodes whose edges a thread writes together.
constexpr std::size_t kPerBlock = 256, kPerRange = 32 * kPerBlock;

/// Returns the first edge of each range of nodes, and the end. Edges belong to their lower node.
std::vector<std::size_t> first_edges(const TriPatch& tri, const std::vector<int>& node) {
  const std::size_t n = node.size();
  std::vector<std::atomic<std::size_t>> counts(n / kPerRange + 1);
  parallel_each(n, [&](std::size_t t) {
    std::size_t higher = 0;
    for (const int u : tri.neighbours[t]) higher += u >= 0 && node[u] > node[t];
    counts[node[t] / kPerRange].fetch_add(higher, std::memory_order_relaxed);
  });
  std::vector<std::size_t> first = {0};
  for (const auto& count : counts) first.push_back(first.back() + count);
  return first;
}

/// A block of nodes and their sides to higher nodes. It works in steps; each prefetches data for the next
/// one, and none has branches that are hard to predict.
class SideBlock {
 public:
  SideBlock(const TriPatch& tri, const std::vector<int>& triangle, const std::vector<int>& node)
      : tri_(tri), triangle_(triangle), node_(node) {}

  /// Writes the edges of nodes [begin, end). Returns their end.
  MatchingGraph::Edge* write(std::size_t begin, std::size_t end, MatchingGraph::Edge* edge) {
    for (std::size_t i = begin; i < end; ++i) __builtin_prefetch(&tri_.neighbours[triangle_[i]]);
    for (std::size_t i = begin; i < end; ++i) {
      for (const int u : tri_.neighbours[triangle_[i]]) __builtin_prefetch(&node_[std::max(u, 0)]);
    }
    list_sides(begin, end);
    for (std::size_t k = 0; k < n_; ++k) {
      quads_[k] = merged_quad(tri_, triangle_[sides_[k].node], sides_[k].side, triangle_[sides_[k].other]);
      for (const int v : quads_[k]) __builtin_prefetch(&tri_.points[v]);
    }
    for (std::size_t k = 0; k < n_; ++k) {
      *edge++ = {sides_[k].node, sides_[k].other, merge_cost(tri_, quads_[k])};
    }
    return edge;
  }

 private:
  struct Side {
    int node, side, other;
  };

  void list_sides(std::size_t begin, std::size_t end) {
    n_ = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const int t = triangle_[i];
      __builtin_prefetch(&tri_.triangles[t]);
      for (int side = 0; side < 3; ++side) {
        const int u = tri_.neighbours[t][side], other = u < 0 ? -1 : node_[u];
        sides_[n_] = {static_cast<int>(i), side, other};
        n_ += other > static_cast<int>(i);
        __builtin_prefetch(&tri_.triangles[std::max(u, 0)]);
      }
    }
  }

  const TriPatch& tri_;
  const std::vector<int>&triangle_, &node_;
  std::size_t n_ = 0;
  std::array<Side, 3 * kPerBlock> sides_;
  std::array<std::array<int, 4>, 3 * kPerBlock> quads_;
};

std::vector<MatchingGraph::Edge> interior_sides(const TriPatch& tri, const std::vector<int>& triangle,
                                                const std::vector<int>& node,
                                                const std::vector<std::size_t>& first_edge) {
  const std::size_t n = triangle.size();
  std::vector<MatchingGraph::Edge> edges(first_edge.back());
  parallel_for((n + kPerRange - 1) / kPerRange, [&](std::size_t range) {
    SideBlock block(tri, triangle, node);
    MatchingGraph::Edge* edge = edges.data() + first_edge[range];
    const std::size_t range_end = std::min(n, (range + 1) * kPerRange);
    for (std::size_t begin = range * kPerRange; begin < range_end; begin += kPerBlock) {
      edge = block.write(begin, std::min(begin + kPerBlock, range_end), edge);
    }
  });
  return edges;
}

struct BoundarySide {
  int triangle, from, to;  ///< vertices, counterclockwise
};

std::vector<BoundarySide> boundary_sides(const TriPatch& tri) {
  using Sides = std::vector<BoundarySide>;
  return parallel_collect<BoundarySide>(
      tri.triangles.size(), [&](std::size_t begin, std::size_t end, Sides& sides) {
        for (std::size_t t = begin; t < end; ++t) {
          for (int side = 0; side < 3; ++side) {
            if (tri.neighbours[t][side] >= 0) continue;
            const auto& v = tri.triangles[t];
            sides.push_back({static_cast<int>(t), v[(side + 1) % 3], v[(side + 2) % 3]});
          }
        }
      });
}

void add_extra_edges(const TriPatch& tri, const std::vector<int>& node, long long cost, DualGraph& dual) {
  std::vector<int> first(tri.n_boundary, -1), last(tri.n_boundary, -1);
  for (const BoundarySide& side : boundary_sides(tri)) {
    first[side.from] = side.triangle;
    last[side.to] = side.triangle;
  }
  for (int b = 0; b < tri.n_boundary; ++b) {
    if (first[b] < 0 || first[b] == last[b] || facing_side(tri, first[b], last[b]) >= 0) continue;
    dual.graph.edges.push_back({node[first[b]], node[last[b]], cost});
    dual.extra_vertex.push_back(b);
  }
}

/// Returns the first node of each node's component, joined within ranges first, then across.
std::vector<int> first_nodes(const MatchingGraph& graph, const std::vector<std::size_t>& first_edge) {
  DisjointSets components(graph.n_nodes);
  std::vector<std::vector<MatchingGraph::Edge>> across(first_edge.size() - 1);
  parallel_for(across.size(), [&](std::size_t range) {
    const int end = static_cast<int>(std::min(components.size(), (range + 1) * kPerRange));
    for (std::size_t e = first_edge[range]; e < first_edge[range + 1]; ++e) {
      if (graph.edges[e].b >= end) {
        across[range].push_back(graph.edges[e]);
      } else {
        components.join(graph.edges[e].a, graph.edges[e].b);
      }
    }
  });
  for (const auto& edges : across) {
    for (const auto& edge : edges) components.join(edge.a, edge.b);
  }
  return components.roots();
}

/// Adds a spare for each odd component, in the order of first nodes.
void add_spares(DualGraph& dual, const std::vector<std::size_t>& first_edge) {
  const int n = dual.graph.n_nodes;
  const std::vector<int> first = first_nodes(dual.graph, first_edge);
  std::vector<int> spare(n, 0);
  for (const int v : first) spare[v] ^= 1;
  for (int v = 0; v < n; ++v) spare[v] = spare[v] != 0 ? dual.graph.n_nodes++ : -1;
  if (dual.graph.n_nodes == n) return;
  for (int v = 0; v < n; ++v) {
    if (spare[first[v]] >= 0) dual.graph.edges.push_back({v, spare[first[v]], 0});
  }
}

}  // namespace

std::array<int, 4> merged_quad(const TriPatch& tri, int t, int side, int u) {
  const auto &v = tri.triangles[t], &w = tri.triangles[u];
  const int a = v[(side + 1) % 3], b = v[(side + 2) % 3];
  const int opposite = w[0] ^ w[1] ^ w[2] ^ a ^ b;
  return {v[side], a, opposite, b};
}

DualGraph build_dual_graph(const TriPatch& tri, long long extra_edge_cost) {
  DualGraph dual;
  dual.triangle = triangles_along_curve(tri);
  dual.graph.n_nodes = static_cast<int>(tri.triangles.size());
  std::vector<int> node(tri.triangles.size());
  parallel_each(node.size(), [&](std::size_t i) { node[dual.triangle[i]] = static_cast<int>(i); });
  const std::vector<std::size_t> first_edge = first_edges(tri, node);
  dual.graph.edges = interior_sides(tri, dual.triangle, node, first_edge);
  dual.first_extra = static_cast<int>(dual.graph.edges.size());
  add_extra_edges(tri, node, extra_edge_cost, dual);
  check_cancelled();
  add_spares(dual, first_edge);
  return dual;
}

namespace {

struct Corner {
  double cross, dot;  ///< of the sides that leave the corner, forward and backward
};

Corner corner(Vec2 before, Vec2 at, Vec2 after) {
  const Vec2 u = after - at, v = before - at;
  return {cross(u, v), dot(u, v)};
}

/// Returns |angle - 90 deg| with the angle in [0, 360) degrees, in radians.
double deviation(Corner c) {
  const double angle = std::atan2(c.cross, c.dot);
  return std::abs((angle < 0 ? angle + 2 * std::numbers::pi : angle) - std::numbers::pi / 2);
}

}  // namespace

double signed_eta(Vec2 a, Vec2 b, Vec2 c, Vec2 d) {
  const Corner corners[4] = {corner(d, a, b), corner(a, b, c), corner(b, c, d), corner(c, d, a)};
  // In a convex quad |dot| / cross is the tangent of the deviation, so one arc tangent is enough.
  double worst = 0;
  bool convex = true;
  for (const Corner& k : corners) {
    convex = convex && k.cross > 0;
    worst = std::max(worst, std::abs(k.dot) / k.cross);
  }
  if (convex) return eta_of_deviation(std::atan(worst));
  worst = 0;
  for (const Corner& k : corners) worst = std::max(worst, deviation(k));
  return eta_of_deviation(worst);
}

}  // namespace delquad
