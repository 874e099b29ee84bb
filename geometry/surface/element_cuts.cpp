// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/surface/element_cuts.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <functional>
#include <limits>
#include <numeric>
#include <queue>
#include <utility>

#include "base/disjoint_sets.h"
#include "geometry/mesh/triangle_measures.h"
#include "geometry/surface/cut_planner.h"
#include "geometry/surface/laplacian.h"

namespace delquad {

namespace {

/// Least area of a part, over the area of the chart.
constexpr double kLeastPart = 0.08;
/// Factor for the length of sides at avoided vertices.
constexpr double kDetour = 8;
/// Number of levels that are tried.
constexpr int kLevels = 16;

/// Returns the cost of a cut along the side from v to w.
double cost_of_side(const Chart& chart, const ChartElements& elements, int v, int w) {
  return norm(chart.points[w] - chart.points[v]) * (elements.avoided[v] || elements.avoided[w] ? kDetour : 1);
}

/// The elements of a chart, with new numbers, and the sides between them.
class ElementGraph {
 public:
  ElementGraph(const Chart& chart, const ChartElements& elements) : chart_(chart), elements_(elements) {
    const std::vector<int>& element = elements.element;
    std::vector<int> order(element.size());
    std::iota(order.begin(), order.end(), 0);
    std::ranges::stable_sort(order, {}, [&](int t) { return element[t]; });
    number_.resize(element.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
      if (i == 0 || element[order[i]] != element[order[i - 1]]) triangles_.emplace_back();
      number_[order[i]] = static_cast<int>(triangles_.size()) - 1;
      triangles_.back().push_back(order[i]);
    }
  }

  int size() const { return static_cast<int>(triangles_.size()); }
  int of_triangle(std::size_t t) const { return number_[t]; }
  bool is_triangle(int e) const { return triangles_[e].size() == 1; }
  double area(int e) const {
    double area = 0;
    for (const int t : triangles_[e]) area += norm(area_vector(chart_.points, chart_.triangles[t])) / 2;
    return area;
  }
  double mean(int e, const std::vector<double>& u) const {
    double sum = 0;
    for (const int t : triangles_[e])
      for (const int v : chart_.triangles[t]) sum += u[v];
    return sum / (3 * static_cast<double>(triangles_[e].size()));
  }
  /// Calls visit(other element, cost of a cut along the side) for the elements beside this one.
  template <class Visit>
  void for_each_side(int e, Visit visit) const {
    for (const int t : triangles_[e])
      for (int k = 0; k < 3; ++k) {
        const int s = chart_.neighbours[t][k];
        if (s < 0 || number_[s] == e) continue;
        const auto& v = chart_.triangles[t];
        visit(number_[s], cost_of_side(chart_, elements_, v[(k + 1) % 3], v[(k + 2) % 3]));
      }
  }

 private:
  const Chart& chart_;
  const ChartElements& elements_;
  std::vector<int> number_;                  ///< element of each triangle
  std::vector<std::vector<int>> triangles_;  ///< triangles of each element
};

using Parts = std::vector<char>;  // part of each element, 0 or 1

/// Returns the component of each element within its part, and the sizes of components.
std::pair<std::vector<int>, std::vector<int>> components(const ElementGraph& graph, const Parts& part) {
  DisjointSets joined(part.size());
  for (int e = 0; e < graph.size(); ++e)
    graph.for_each_side(e, [&](int other, double) {
      if (part[other] == part[e]) joined.join(e, other);
    });
  std::vector<int> component = joined.places(), sizes;
  for (const int c : component) {
    sizes.resize(std::max<std::size_t>(sizes.size(), c + 1), 0);
    ++sizes[c];
  }
  return {std::move(component), std::move(sizes)};
}

/// Keeps the largest component of both parts; other components join their surroundings.
void join_islands(const ElementGraph& graph, Parts& part) {
  const auto [component, sizes] = components(graph, part);
  std::array<int, 2> largest{-1, -1};
  for (std::size_t e = 0; e < part.size(); ++e) {
    int& best = largest[part[e]];
    if (best < 0 || sizes[component[e]] > sizes[best]) best = component[e];
  }
  const Parts before = part;
  for (std::size_t e = 0; e < part.size(); ++e)
    if (component[e] != largest[before[e]]) part[e] = static_cast<char>(1 - part[e]);
}

bool has_both(const Parts& part) {
  return std::ranges::find(part, 0) != part.end() && std::ranges::find(part, 1) != part.end();
}

/// Moves a triangle between the parts so that both have an even number.
void make_even(const ElementGraph& graph, Parts& part) {
  const auto ones = std::ranges::count(part, 1);
  if (graph.size() % 2 != 0 || ones % 2 == 0) return;
  for (int e = 0; e < graph.size(); ++e)
    if (!graph.is_triangle(e)) return;
  const std::size_t pieces = components(graph, part).second.size();
  constexpr int kMostTried = 64;
  int tried = 0;
  for (const int wanted : {2, 1})
    for (int e = 0; e < graph.size() && tried < kMostTried; ++e) {
      int across = 0;
      graph.for_each_side(e, [&](int other, double) { across += part[other] != part[e]; });
      if (across != wanted) continue;
      ++tried;
      part[e] = static_cast<char>(1 - part[e]);
      if (components(graph, part).second.size() == pieces) return;
      part[e] = static_cast<char>(1 - part[e]);
    }
}

Parts best_level(const Chart& chart, const ElementGraph& graph) {
  const std::vector<double> u = fiedler_function(chart);
  std::vector<double> value, area;
  for (int e = 0; e < graph.size(); ++e) {
    value.push_back(graph.mean(e, u));
    area.push_back(graph.area(e));
  }
  std::vector<int> order(value.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, {}, [&](int e) { return value[e]; });
  const double total = std::accumulate(area.begin(), area.end(), 0.0);
  Parts best;
  double least = std::numeric_limits<double>::infinity(), sum = 0;
  int level = 1;
  Parts part(value.size(), 0);
  for (const int next : order) {
    part[next] = 1;
    sum += area[next];
    if (!(sum * kLevels >= level * total)) continue;
    while (level * total <= sum * kLevels) ++level;
    Parts tried = part;
    join_islands(graph, tried);
    double length = 0, side = 0;
    for (int e = 0; e < graph.size(); ++e) {
      side += tried[e] != 0 ? area[e] : 0;
      graph.for_each_side(e, [&](int other, double l) { length += tried[other] != tried[e] ? l : 0; });
    }
    side = std::min(side, total - side);
    if (!has_both(tried) || side < kLeastPart * total || !(length / side < least)) continue;
    least = length / side;
    best = std::move(tried);
  }
  return best;
}

}  // namespace

std::optional<CutPath> path_beside_elements(const Chart& chart, const ChartElements& elements,
                                            const std::vector<char>& from, const std::vector<char>& to) {
  assert(elements.element.size() == chart.triangles.size());
  assert(elements.avoided.empty() || elements.avoided.size() == chart.points.size());
  assert(from.size() == chart.points.size() && to.size() == chart.points.size());
  const std::size_t n = chart.points.size();
  const std::vector<int>& element = elements.element;
  std::vector<std::vector<int>> beside(n);
  for (std::size_t t = 0; t < chart.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const int s = chart.neighbours[t][k];
      if (s < 0 || element[s] == element[t]) continue;
      // Each side occurs in both triangles.
      beside[chart.triangles[t][(k + 1) % 3]].push_back(chart.triangles[t][(k + 2) % 3]);
    }
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  std::vector<double> way(n, std::numeric_limits<double>::infinity());
  std::vector<int> before(n, -1);
  for (std::size_t v = 0; v < n; ++v)
    if (from[v]) {
      way[v] = 0;
      queue.emplace(0, static_cast<int>(v));
    }
  while (!queue.empty()) {
    const auto [length, v] = queue.top();
    queue.pop();
    if (length > way[v]) continue;
    if (to[v]) {
      CutPath path{{}, false, length};
      for (int w = v; w >= 0; w = before[w]) path.points.push_back({w});
      std::ranges::reverse(path.points);
      return path;
    }
    if (v < chart.n_boundary && !from[v]) continue;
    for (const int w : beside[v]) {
      const double longer = length + cost_of_side(chart, elements, v, w);
      if (!(longer < way[w]) || (w < chart.n_boundary && !to[w])) continue;
      way[w] = longer;
      before[w] = v;
      queue.emplace(longer, w);
    }
  }
  return std::nullopt;
}

std::vector<char> plan_division(const Chart& chart, const ChartElements& elements) {
  assert(elements.element.size() == chart.triangles.size());
  const ElementGraph graph(chart, elements);
  if (graph.size() < 2) return {};
  Parts part = best_level(chart, graph);
  if (part.empty()) {
    const std::vector<char> of_triangles = plan_split(chart);
    part.assign(static_cast<std::size_t>(graph.size()), 0);
    for (std::size_t t = 0; t < of_triangles.size(); ++t)
      if (of_triangles[t]) part[graph.of_triangle(t)] = 1;
    if (!has_both(part)) part.assign(part.size(), 0), part.back() = 1;
  }
  make_even(graph, part);
  std::vector<char> of_triangle;
  for (std::size_t t = 0; t < chart.triangles.size(); ++t) of_triangle.push_back(part[graph.of_triangle(t)]);
  return of_triangle;
}

}  // namespace delquad
