#include "patches/curve_nodes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <unordered_map>

#include "base/disjoint_sets.h"
#include "base/matching/t_join.h"
#include "delquad/error.h"
#include "patches/divided_chains.h"

namespace delquad {

namespace {

/// Splitting a curve of one or two edges distorts it most: the T-join avoids these where it can.
constexpr double kFewEdgesPenalty = 4;

/// Numbers mod 2, by the places of the ones.
using Parities = std::set<int>;

void add(Parities& to, const Parities& other) {
  for (const int i : other)
    if (const auto [at, added] = to.insert(i); !added) to.erase(at);
}

/// Parts of the graph that hang together, by node.
std::vector<int> components(const WeightedGraph& graph) {
  DisjointSets parts(graph.n_nodes);
  for (const auto& e : graph.edges) parts.join_to(e.b, e.a);
  return parts.roots();
}

/// A curve at which more than two patches meet is no edge of a graph, and a change of it by one changes the
/// parity of several parts of the graph. Returns the curves (indices into `costs`) to change so that each
/// part has an even number of odd patches, where that can be: a sum of columns mod 2, by elimination, in
/// which cheap columns come first.
std::vector<int> columns_for(const std::vector<Parities>& columns, const std::vector<double>& costs,
                             Parities wanted) {
  struct Row {
    Parities column, made_of;
  };
  std::map<int, Row> basis;  // by the first place of the column
  const auto reduce = [&](Row& row) {
    while (!row.column.empty()) {
      const auto at = basis.find(*row.column.begin());
      if (at == basis.end()) return;
      add(row.column, at->second.column);
      add(row.made_of, at->second.made_of);
    }
  };
  std::vector<int> order(columns.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, {}, [&](int c) { return costs[c]; });
  for (const int c : order) {
    Row row{columns[c], {c}};
    reduce(row);
    if (!row.column.empty()) basis.emplace(*row.column.begin(), row);
  }
  Row sum{std::move(wanted), {}};
  Parities chosen;
  while (!sum.column.empty()) {  // what no column has stays odd
    const auto at = basis.find(*sum.column.begin());
    if (at == basis.end()) {
      sum.column.erase(sum.column.begin());
      continue;
    }
    add(sum.column, at->second.column);
    add(chosen, at->second.made_of);
  }
  return {chosen.begin(), chosen.end()};
}

/// n + 1 or n - 1, whichever is nearer to the integral in ratio and allowed.
int changed_by_one(int n, const CurveDemand& curve) {
  if (n - 1 < curve.minimum) return n + 1;
  const auto misfit = [&](int m) { return std::abs(std::log(m / std::max(curve.integral, 1e-3))); };
  return misfit(n - 1) < misfit(n + 1) ? n - 1 : n + 1;
}

double cost_of_change(int n, const CurveDemand& curve) {
  const double change = std::abs(std::log(changed_by_one(n, curve) / static_cast<double>(n)));
  return change * (n <= 2 ? kFewEdgesPenalty : 1);
}

/// Changes curves at which more than two patches meet, so that the others can do the rest.
void even_branches(const std::vector<CurveDemand>& curves, const std::vector<int>& branching,
                   const WeightedGraph& graph, std::vector<int>& counts, std::vector<int>& total) {
  if (branching.empty()) return;
  const std::vector<int> part = components(graph);
  const int free_part = part.back();  // the outside's
  const auto parity = [&](const std::vector<int>& patches) {
    Parities odd;
    for (const int p : patches)
      if (part[p] != free_part) add(odd, {part[p]});
    return odd;
  };
  std::vector<int> odd_patches;
  for (size_t p = 0; p < total.size(); ++p)
    if (total[p] % 2) odd_patches.push_back(static_cast<int>(p));
  std::vector<Parities> columns;
  std::vector<double> costs;
  for (const int c : branching) {
    columns.push_back(parity(curves[c].patches));
    costs.push_back(cost_of_change(counts[c], curves[c]));
  }
  for (const int i : columns_for(columns, costs, parity(odd_patches))) {
    const int c = branching[i], n = changed_by_one(counts[c], curves[c]);
    for (const int p : curves[c].patches) total[p] += n - counts[c];
    counts[c] = n;
  }
}

}  // namespace

std::vector<CurveChain> curve_chains(const SurfaceModel& model) {
  const Mesh& fine = model.fine;
  std::vector<std::vector<int>> whole(fine.curves.size());
  for (size_t i = 0; i < fine.lines.size(); ++i) {
    auto& points = whole[fine.line_curve[i]];
    const auto& [a, b] = fine.lines[i];
    if (points.empty()) points.push_back(a);
    if (points.back() != a) {
      throw InputError(
          fmt::format("curve {}: its lines do not form one chain", fine.curves[fine.line_curve[i]].tag));
    }
    points.push_back(b);
  }
  std::vector<CurveChain> chains;
  for (size_t c = 0; c < whole.size(); ++c) {
    auto& points = whole[c];
    if (points.empty()) throw InputError(fmt::format("curve {} has no lines", fine.curves[c].tag));
    const auto is_corner = [&](int p) {
      return std::binary_search(model.corners.begin(), model.corners.end(), p);
    };
    const auto first = std::find_if(points.begin(), points.end(), is_corner);
    if (points.front() == points.back() && first != points.end() && first != points.begin()) {
      points.pop_back();  // a closed curve begins at a corner where it has one
      std::rotate(points.begin(), first, points.end());
      points.push_back(points.front());
    }
    CurveChain chain{static_cast<int>(c), {points.front()}};
    for (size_t i = 1; i < points.size(); ++i) {
      chain.points.push_back(points[i]);
      if (i + 1 == points.size() || !is_corner(points[i])) continue;
      chains.push_back(std::move(chain));
      chain = {static_cast<int>(c), {points[i]}};
    }
    chains.push_back(std::move(chain));
  }
  return chains;
}

std::vector<int> even_counts(const std::vector<CurveDemand>& curves, int n_patches,
                             const MatchingSolver& solver, std::vector<int>& odd_patches) {
  std::vector<int> counts;
  std::vector<int> total(n_patches, 0);
  WeightedGraph graph{n_patches + 1, {}};  // the last node is the outside
  std::vector<int> curve_of_edge, branching;
  for (size_t c = 0; c < curves.size(); ++c) {
    const CurveDemand& curve = curves[c];
    const int n = curve.exact > 0 ? curve.exact
                                  : std::max(curve.minimum, static_cast<int>(std::lround(curve.integral)));
    counts.push_back(n);
    for (const int p : curve.patches) total[p] += n;
    if (curve.exact > 0) continue;
    if (curve.patches.size() > 2) branching.push_back(static_cast<int>(c));
    if (curve.patches.empty() || curve.patches.size() > 2) continue;
    const int a = curve.patches[0], b = curve.patches.size() == 2 ? curve.patches[1] : n_patches;
    if (a == b) continue;
    graph.edges.push_back({a, b, cost_of_change(n, curve)});
    curve_of_edge.push_back(static_cast<int>(c));
  }
  even_branches(curves, branching, graph, counts, total);
  std::vector<int> terminals;
  for (int p = 0; p < n_patches; ++p) {
    if (total[p] % 2) terminals.push_back(p);
  }
  // The outside takes part where its component has an odd number of odd patches.
  TJoin join = minimum_t_join(graph, terminals, solver);
  if (!join.unmatched.empty()) {
    std::vector<int> with_outside = terminals;
    with_outside.push_back(n_patches);
    const TJoin other = minimum_t_join(graph, with_outside, solver);
    if (std::count_if(other.unmatched.begin(), other.unmatched.end(), [&](int t) { return t < n_patches; }) <
        static_cast<long>(join.unmatched.size())) {
      join = other;
    }
  }
  for (const int e : join.edges) {
    const int c = curve_of_edge[e];
    counts[c] = changed_by_one(counts[c], curves[c]);
  }
  odd_patches.clear();
  for (const int t : join.unmatched) {
    if (t < n_patches) odd_patches.push_back(t);
  }
  std::sort(odd_patches.begin(), odd_patches.end());
  return counts;
}

namespace {

/// A piece of a fine line over which the integral is taken at once is at most this part of the size there,
/// but for the most pieces a line may have.
constexpr double kPiece = 0.25;
constexpr int kMostPieces = 4096;

}  // namespace

SizeIntegral size_integral(const Mesh& fine, const CurveChain& chain, const SizeOnLine& size,
                           std::span<const double> limits) {
  constexpr double kGauss = 0.21132486540518713;  // (1 - 1/sqrt 3) / 2
  SizeIntegral table;
  int hint = -1;
  table.entries.push_back({0, 0});
  for (size_t i = 0; i + 1 < chain.points.size(); ++i) {
    const Vec3 a = fine.points[chain.points[i]], d = fine.points[chain.points[i + 1]] - a;
    const double length = norm(d), shortest = 1.0 / kMostPieces;
    const auto size_at = [&](double t) {
      const double wanted = size(chain.points[i], chain.points[i + 1], t, a + t * d, hint);
      return limits.empty() ? wanted : std::min(wanted, (1 - t) * limits[i] + t * limits[i + 1]);
    };
    for (double t = 0; t < 1;) {
      // The size at the piece's middle may be far smaller than at its beginning: halved until it fits.
      double step = std::clamp(kPiece * size_at(t) / length, shortest, 1.0);
      while (step > shortest && step * length > 2 * kPiece * size_at(std::min(t + step, 1.0))) step /= 2;
      if (t + 1.5 * step > 1) step = 1 - t;
      double sum = 0;
      for (const double g : {kGauss, 1 - kGauss}) sum += 1 / size_at(t + g * step);
      t = t + step < 1 ? t + step : 1;
      table.entries.push_back({static_cast<double>(i) + t, table.total() + step * length * sum / 2});
    }
  }
  return table;
}

double SizeIntegral::s_at(double part) const {
  const double target = part * total();
  const auto after = std::upper_bound(entries.begin() + 1, entries.end() - 1, target,
                                      [](double x, const Entry& e) { return x < e.integral; });
  const Entry& before = *(after - 1);
  const double t = std::clamp((target - before.integral) / (after->integral - before.integral), 0.0, 1.0);
  return before.s + t * (after->s - before.s);
}

double SizeIntegral::part_at(double s) const {
  const auto after = std::upper_bound(entries.begin() + 1, entries.end() - 1, s,
                                      [](double x, const Entry& e) { return x < e.s; });
  const Entry& before = *(after - 1);
  const double t = std::clamp((s - before.s) / (after->s - before.s), 0.0, 1.0);
  return (before.integral + t * (after->integral - before.integral)) / total();
}

CurvePlaces equal_places(const std::vector<int>& counts) {
  CurvePlaces places;
  for (const int n : counts) {
    places.emplace_back();
    for (int k = 0; k <= n; ++k) places.back().push_back(k);
  }
  return places;
}

Vec3 place_on_curve(const SurfaceModel& model, const CurveChain& chain, const std::vector<int>& cut_face,
                    double s) {
  const Vec3 x = fine_point_at(model.fine, chain, s);
  if (!model.projector) return x;
  const int face = cut_face[chain.curve];
  return face >= 0 ? model.projector->to_face(face, x) : model.projector->to_curve(chain.curve, x);
}

SurfaceNodes place_nodes(const SurfaceModel& model, const std::vector<CurveChain>& chains,
                         const std::vector<int>& cut_face, const std::vector<SizeIntegral>& integrals,
                         const CurvePlaces& places) {
  const Mesh& fine = model.fine;
  SurfaceNodes nodes;
  std::unordered_map<int, int> node_of_point;  // only looked up, never iterated
  const auto end_node = [&](int point) {
    const auto [it, added] = node_of_point.try_emplace(point, static_cast<int>(nodes.points.size()));
    if (added) nodes.points.push_back(fine.points[point]);
    return it->second;
  };
  for (size_t c = 0; c < chains.size(); ++c) {
    const auto& points = chains[c].points;
    auto& on_curve = nodes.on_curve.emplace_back();
    on_curve.push_back({0, end_node(points.front())});
    const size_t n = places[c].size() - 1;
    for (size_t k = 1; k < n; ++k) {
      const double s = integrals[c].s_at(places[c][k] / static_cast<double>(n));
      on_curve.push_back({s, static_cast<int>(nodes.points.size())});
      nodes.points.push_back(place_on_curve(model, chains[c], cut_face, s));
    }
    on_curve.push_back({static_cast<double>(points.size() - 1), end_node(points.back())});
  }
  return nodes;
}

}  // namespace delquad
