// SPDX-License-Identifier: GPL-3.0-or-later
#include "algorithms/insertion/linf_delaunay.h"

#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Segment_Delaunay_graph_Linf_2.h>
#include <CGAL/Segment_Delaunay_graph_Linf_filtered_traits_2.h>
#include <CGAL/Simple_cartesian.h>

#include <algorithm>
#include <cassert>
#include <iterator>
#include <map>

namespace delquad {

namespace {

using Edges = std::vector<std::array<int, 2>>;
using PointIndex = std::map<std::pair<double, double>, int>;

Edges sorted(Edges edges) {
  for (auto& e : edges) std::sort(e.begin(), e.end());
  std::sort(edges.begin(), edges.end());
  return edges;
}

template <class Point>
int index_of(const PointIndex& index, const Point& p) {
  return index.at({CGAL::to_double(p.x()), CGAL::to_double(p.y())});
}

Edges l2_edges(const std::vector<Vec2>& points, const PointIndex& index, std::vector<char>& on_hull) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  CGAL::Delaunay_triangulation_2<Kernel> delaunay;
  for (const Vec2 p : points) delaunay.insert(Kernel::Point_2(p.x, p.y));
  Edges edges;
  for (auto e = delaunay.finite_edges_begin(); e != delaunay.finite_edges_end(); ++e) {
    const auto& f = e->first;
    edges.push_back({index_of(index, f->vertex(f->cw(e->second))->point()),
                     index_of(index, f->vertex(f->ccw(e->second))->point())});
  }
  auto v = delaunay.incident_vertices(delaunay.infinite_vertex());
  if (const auto done = v; v != nullptr) {
    do on_hull[index_of(index, v->point())] = 1;
    while (++v != done);
  }
  return sorted(std::move(edges));
}

Edges linf_edges(const std::vector<Vec2>& points, const PointIndex& index) {
  using Traits = CGAL::Segment_Delaunay_graph_Linf_filtered_traits_2<CGAL::Simple_cartesian<double>>;
  using Graph = CGAL::Segment_Delaunay_graph_Linf_2<Traits>;
  Graph graph;
  for (const Vec2 p : points) graph.insert(Graph::Point_2(p.x, p.y));
  Edges edges;
  for (auto e = graph.finite_edges_begin(); e != graph.finite_edges_end(); ++e) {
    const auto& f = e->first;
    edges.push_back({index_of(index, f->vertex(f->cw(e->second))->site().point()),
                     index_of(index, f->vertex(f->ccw(e->second))->site().point())});
  }
  return sorted(std::move(edges));
}

}  // namespace

LinfDelaunayComparison compare_linf_delaunay(const std::vector<Vec2>& points) {
  PointIndex index;
  for (size_t i = 0; i < points.size(); ++i) index[{points[i].x, points[i].y}] = static_cast<int>(i);
  assert(index.size() == points.size());
  std::vector<char> on_hull(points.size(), 0);
  Edges l2 = l2_edges(points, index, on_hull), linf = linf_edges(points, index);
  for (Edges* edges : {&l2, &linf}) {
    std::erase_if(*edges, [&](const auto& e) { return on_hull[e[0]] && on_hull[e[1]]; });
  }
  LinfDelaunayComparison result;
  std::set_intersection(l2.begin(), l2.end(), linf.begin(), linf.end(), std::back_inserter(result.both));
  std::set_difference(l2.begin(), l2.end(), linf.begin(), linf.end(), std::back_inserter(result.only_l2));
  std::set_difference(linf.begin(), linf.end(), l2.begin(), l2.end(), std::back_inserter(result.only_linf));
  return result;
}

}  // namespace delquad
