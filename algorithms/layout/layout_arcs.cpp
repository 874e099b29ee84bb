// SPDX-License-Identifier: GPL-3.0-or-later
#include "algorithms/layout/layout_arcs.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "geometry/mesh/quad_corners.h"

namespace delquad {

LayoutArcs::LayoutArcs(PatchLayout layout, const PatchBoundary& boundary, std::span<const int> runs,
                       const ParametricSize& size)
    : vertices_(std::move(layout.vertices)), of_runs_(runs.size()) {
  const std::vector<Vec2>& x = vertices_.places;
  std::vector<int> next(x.size(), -1), edge(x.size(), -1), run_of;
  std::set<int> nodes;
  for (std::size_t e = 0; e < boundary.edges.size(); ++e) {
    const auto& [a, b] = boundary.edges[e];
    next[a] = b, edge[a] = static_cast<int>(e);
  }
  for (std::size_t r = 0; r < runs.size(); ++r) {
    nodes.insert(boundary.edges[run_of.size()][0]);
    run_of.insert(run_of.end(), runs[r], static_cast<int>(r));
  }
  std::map<int, std::set<int>> beside;
  for (const Rim& rim : layout.pieces)
    for (std::size_t i = 0; i < rim.size(); ++i) {
      const int a = rim[i].vertex, b = rim[(i + 1) % rim.size()].vertex;
      beside[a].insert(b), beside[b].insert(a);
      if (rim[i].quads != 2) nodes.insert(a);
    }
  for (const auto& [v, others] : beside)
    if (others.size() != 2) nodes.insert(v);

  std::map<std::pair<int, int>, Step> begins;  // by their first two vertices
  int hint = -1;
  for (const Rim& rim : layout.pieces) {
    auto& steps = pieces_.emplace_back();
    const int n = static_cast<int>(rim.size());
    int first = 0;
    while (first < n && !nodes.contains(rim[first].vertex)) ++first;
    if (first == n) nodes.insert(rim[first = 0].vertex);
    for (int i = first; i < first + n;) {
      const int quads = rim[i % n].quads;
      std::vector<int> row{rim[i % n].vertex};
      do row.push_back(rim[++i % n].vertex);
      while (!nodes.contains(row.back()));
      const int arc = static_cast<int>(arcs_.size());
      const auto [found, is_new] = begins.try_emplace({row[0], row[1]}, Step{arc, true, 0});
      steps.push_back({found->second.arc, found->second.forward, quads});
      if (!is_new) continue;
      begins.try_emplace({row[row.size() - 1], row[row.size() - 2]}, Step{arc, false, 0});
      if (next[row[0]] == row[1]) of_runs_[run_of[edge[row[0]]]].push_back(arc);
      double length = 0;
      for (std::size_t k = 0; k + 1 < row.size(); ++k)
        length += norm(x[row[k + 1]] - x[row[k]]) / size.at(0.5 * (x[row[k]] + x[row[k + 1]]), hint);
      arcs_.push_back({std::move(row), std::max(length, kTinyLength)});
    }
  }
  for (auto& arcs : of_runs_) std::ranges::sort(arcs, {}, [&](int a) { return edge[arcs_[a].vertices[0]]; });
}

PatchLayout LayoutArcs::with(std::span<const int> edges, const PatchBoundary& boundary,
                             const ParametricSize& size) const {
  PatchLayout layout;
  auto& [places, delta] = layout.vertices;
  int hint = -1;
  const auto add = [&](Vec2 x) {
    places.push_back(x);
    delta.push_back(size.at(x, hint));
    return static_cast<int>(places.size()) - 1;
  };
  std::ranges::for_each(boundary.points, add);
  std::vector<int> number(vertices_.places.size(), -1);
  std::vector<std::vector<int>> rows(arcs_.size());
  std::size_t e = 0;
  for (const auto& run : of_runs_)
    for (const int a : run) {
      number[arcs_[a].vertices[0]] = boundary.edges[e][0];
      rows[a].push_back(boundary.edges[e][0]);
      for (int k = 0; k < edges[a]; ++k) rows[a].push_back(boundary.edges[e++][1]);
    }
  for (std::size_t a = 0; a < arcs_.size(); ++a) {
    if (!rows[a].empty()) continue;
    const std::vector<int>& was = arcs_[a].vertices;
    for (const int v : {was.front(), was.back()})
      if (number[v] < 0) number[v] = add(vertices_.places[v]);
    const int from = number[was.front()], to = number[was.back()];
    // The arc follows its ends, which may have moved along the boundary.
    const Vec2 at_from = places[from] - vertices_.places[was.front()],
               at_to = places[to] - vertices_.places[was.back()];
    rows[a].push_back(from);
    for (int k = 1; k < edges[a]; ++k) {
      const double t = static_cast<double>(k) / edges[a], at = t * arcs_[a].edges();
      const auto i = std::min(static_cast<std::size_t>(at), was.size() - 2);
      const Vec2 p = vertices_.places[was[i]], q = vertices_.places[was[i + 1]];
      rows[a].push_back(add(p + (at - static_cast<double>(i)) * (q - p) + (1 - t) * at_from + t * at_to));
    }
    rows[a].push_back(to);
  }
  for (const auto& steps : pieces_) {
    Rim& rim = layout.pieces.emplace_back();
    for (const Step& step : steps)
      for (std::size_t k = 0; k + 1 < rows[step.arc].size(); ++k) {
        const std::size_t i = step.forward ? k : rows[step.arc].size() - 1 - k;
        rim.push_back({rows[step.arc][i], k == 0 ? step.quads : 2});
      }
  }
  return layout;
}

}  // namespace delquad
