// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/surface/chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <utility>

#include "base/disjoint_sets.h"
#include "delquad/error.h"
#include "geometry/mesh/half_edges.h"
#include "geometry/mesh/triangle_measures.h"

namespace delquad {

namespace {

using Side = std::pair<int, int>;  ///< triangle, and which vertex it is opposite to

/// Finds triangles that continue each other, and corners that are one vertex.
class Gluing {
 public:
  Gluing(const Mesh& fine, const std::vector<char>& wanted, const std::vector<char>& open)
      : fine_(fine),
        wanted_(wanted),
        across_(3 * fine.triangles.size(), -1),
        chart_(fine.triangles.size()),
        vertex_(3 * fine.triangles.size()) {
    std::vector<std::pair<int, int>> lines, open_lines;
    for (std::size_t l = 0; l < fine.lines.size(); ++l)
      (open.empty() || !open[l] ? lines : open_lines)
          .push_back(std::minmax(fine.lines[l][0], fine.lines[l][1]));
    std::ranges::sort(lines);
    std::ranges::sort(open_lines);
    const std::vector<HalfEdge> sides = sorted_half_edges(fine);
    for_each_edge(std::span(sides), [&](std::span<const HalfEdge> edge) {
      if (std::ranges::none_of(edge, [&](const HalfEdge& e) { return wanted_[e.element] != 0; })) return;
      const std::pair ends(edge[0].lo, edge[0].hi);
      if (std::ranges::binary_search(lines, ends)) return;
      if (std::ranges::binary_search(open_lines, ends))
        glue_across_line(edge);
      else
        glue(edge);
    });
  }

  int across(int corner) const { return across_[corner]; }
  int chart_of(int triangle) { return chart_.root(triangle); }
  int vertex_of(int corner) { return vertex_.root(corner); }

 private:
  int corner(int triangle, int node) const {
    const auto& v = fine_.triangles[triangle];
    return 3 * triangle + static_cast<int>(std::ranges::find(v, node) - v.begin());
  }

  /// Returns whether two wanted triangles of one face with one orientation share the edge.
  bool continues(std::span<const HalfEdge> edge) const {
    return edge.size() == 2 && wanted_[edge[1].element] && wanted_[edge[0].element] &&
           edge[0].forward != edge[1].forward &&
           fine_.triangle_region[edge[0].element] == fine_.triangle_region[edge[1].element];
  }

  /// Joins the triangles of each face on both sides of an open line.
  void glue_across_line(std::span<const HalfEdge> edge) {
    for (const HalfEdge& a : edge)
      for (const HalfEdge& b : edge)
        if (const std::array pair{a, b}; a.element < b.element && continues(pair)) glue(pair);
  }

  void glue(std::span<const HalfEdge> edge) {
    const HalfEdge& e = edge[0];
    if (!continues(edge)) {
      const int face = fine_.triangle_region[e.element];
      throw InputError(
          fmt::format("face {}: the side between nodes {} and {} is on no curve, but is not shared by two "
                      "triangles of one face with one orientation",
                      fine_.regions[face].tag, e.lo + 1, e.hi + 1));
    }
    const int t = e.element, s = edge[1].element;
    chart_.join(t, s);
    int inner[2] = {3, 3};
    for (int node : {e.lo, e.hi}) {
      const int ct = corner(t, node), cs = corner(s, node);
      vertex_.join(ct, cs);
      inner[0] -= ct % 3;
      inner[1] -= cs % 3;
    }
    across_[3 * t + inner[0]] = s;
    across_[3 * s + inner[1]] = t;
  }

  const Mesh& fine_;
  const std::vector<char>& wanted_;
  std::vector<int> across_;
  DisjointSets chart_, vertex_;
};

double length(const Mesh& fine, const std::vector<Side>& loop) {
  double sum = 0;
  for (const auto& [t, k] : loop) {
    const auto& v = fine.triangles[t];
    sum += norm(fine.points[v[(k + 1) % 3]] - fine.points[v[(k + 2) % 3]]);
  }
  return sum;
}

/// Returns the boundary of a chart as closed chains of sides.
std::vector<std::vector<Side>> boundary_loops(const Mesh& fine, Gluing& gluing,
                                              const std::vector<int>& members) {
  std::vector<std::pair<int, Side>> leaving;  // the boundary side that leaves each boundary vertex
  for (int t : members)
    for (int k = 0; k < 3; ++k)
      if (gluing.across(3 * t + k) < 0) leaving.push_back({gluing.vertex_of(3 * t + (k + 1) % 3), {t, k}});
  std::ranges::sort(leaving);
  std::vector<char> used(leaving.size(), 0);
  std::vector<std::vector<Side>> loops;
  for (std::size_t first = 0; first < leaving.size(); ++first) {
    std::vector<Side> loop;
    for (std::size_t i = first; !used[i];) {
      used[i] = 1;
      loop.push_back(leaving[i].second);
      const auto [t, k] = leaving[i].second;
      const int head = gluing.vertex_of(3 * t + (k + 2) % 3);
      i = static_cast<std::size_t>(std::ranges::lower_bound(leaving, head, {}, &std::pair<int, Side>::first) -
                                   leaving.begin());
    }
    if (!loop.empty()) loops.push_back(std::move(loop));
  }
  std::ranges::stable_sort(loops,
                           [&](const auto& a, const auto& b) { return length(fine, a) > length(fine, b); });
  return loops;
}

/// Returns one chart. `number` has -1 for corners without a vertex number.
Chart build_chart(const Mesh& fine, Gluing& gluing, const std::vector<int>& members, std::vector<int>& number,
                  std::vector<int>& position) {
  Chart chart;
  chart.face = fine.triangle_region[members.front()];
  auto vertex = [&](int t, int k) {
    int& n = number[gluing.vertex_of(3 * t + k)];
    if (n < 0) {
      n = static_cast<int>(chart.fine_node.size());
      chart.fine_node.push_back(fine.triangles[t][k]);
      chart.points.push_back(fine.points[chart.fine_node.back()]);
    }
    return n;
  };
  for (const auto& loop : boundary_loops(fine, gluing, members)) {
    auto& out = chart.loops.emplace_back();
    for (const auto& [t, k] : loop) out.push_back(vertex(t, (k + 1) % 3));
  }
  chart.n_boundary = static_cast<int>(chart.points.size());
  for (std::size_t i = 0; i < members.size(); ++i) position[members[i]] = static_cast<int>(i);
  for (int t : members) {
    chart.fine_triangle.push_back(t);
    chart.triangles.push_back({vertex(t, 0), vertex(t, 1), vertex(t, 2)});
    auto& n = chart.neighbours.emplace_back();
    for (int k = 0; k < 3; ++k) {
      const int s = gluing.across(3 * t + k);
      n[k] = s < 0 ? -1 : position[s];
    }
  }
  return chart;
}

}  // namespace

std::vector<Chart> extract_charts(const Mesh& fine, const std::vector<char>& wanted,
                                  const std::vector<char>& open) {
  assert(wanted.size() == fine.triangles.size());
  assert(open.empty() || open.size() == fine.lines.size());
  Gluing gluing(fine, wanted, open);
  std::vector<std::vector<int>> members(fine.triangles.size());
  for (std::size_t t = 0; t < fine.triangles.size(); ++t)
    if (wanted[t]) members[gluing.chart_of(static_cast<int>(t))].push_back(static_cast<int>(t));
  std::vector<int> number(3 * fine.triangles.size(), -1), position(fine.triangles.size());
  std::vector<Chart> charts;
  for (const auto& m : members)
    if (!m.empty()) charts.push_back(build_chart(fine, gluing, m, number, position));
  return charts;
}

int genus(const Chart& chart) {
  const int faces = static_cast<int>(chart.triangles.size());
  const int edges = (3 * faces + chart.n_boundary) / 2;
  const int euler = static_cast<int>(chart.points.size()) - edges + faces;
  return (2 - static_cast<int>(chart.loops.size()) - euler) / 2;
}

std::array<Vec3, 3> corners_at(const std::array<double, 3>& sides) {
  // Lengths of another metric may fit no triangle where the metric varies much.
  constexpr double kFlat = 1e-6;
  const auto& [bc, ca, ab] = sides;
  const double x = (ab * ab + ca * ca - bc * bc) / (2 * ab);
  return {Vec3{}, Vec3{ab, 0, 0}, Vec3{x, std::sqrt(std::max(ca * ca - x * x, kFlat * kFlat * ab * ab)), 0}};
}

std::array<Vec3, 3> corners_of(const Chart& chart, int triangle) {
  const auto& [a, b, c] = chart.triangles[triangle];
  if (chart.sides.empty()) return {chart.points[a], chart.points[b], chart.points[c]};
  return corners_at(chart.sides[triangle]);
}

std::vector<double> boundary_lengths(const Chart& chart) {
  std::vector<double> lengths(static_cast<std::size_t>(chart.n_boundary));
  for (std::size_t t = 0; t < chart.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      if (chart.neighbours[t][k] >= 0) continue;
      const std::array<Vec3, 3> at = corners_of(chart, static_cast<int>(t));
      lengths[chart.triangles[t][(k + 1) % 3]] = norm(at[(k + 2) % 3] - at[(k + 1) % 3]);
    }
  return lengths;
}

std::vector<double> triangle_areas(const Chart& chart) {
  std::vector<double> areas;
  for (int t = 0; t < std::ssize(chart.triangles); ++t) {
    const auto [a, b, c] = corners_of(chart, t);
    areas.push_back(norm(cross(b - a, c - a)) / 2);
  }
  return areas;
}

std::vector<std::vector<int>> triangles_around(const Chart& chart) {
  std::vector<std::vector<int>> around(chart.points.size());
  for (std::size_t t = 0; t < chart.triangles.size(); ++t)
    for (int v : chart.triangles[t]) around[v].push_back(static_cast<int>(t));
  return around;
}

std::vector<double> angle_defects(const Chart& chart) {
  std::vector<double> defect(chart.points.size(), 2 * std::numbers::pi);
  std::fill_n(defect.begin(), chart.n_boundary, std::numbers::pi);
  for (int t = 0; t < std::ssize(chart.triangles); ++t) {
    const std::array<Vec3, 3> at = corners_of(chart, t);
    for (int k = 0; k < 3; ++k)
      defect[chart.triangles[t][k]] -= angle_between(at[(k + 1) % 3] - at[k], at[(k + 2) % 3] - at[k]);
  }
  return defect;
}

}  // namespace delquad
