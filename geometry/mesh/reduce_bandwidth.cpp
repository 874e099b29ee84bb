// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/sort_unique.h"
#include "delquad/mesh.h"

#include <algorithm>
#include <boost/graph/compressed_sparse_row_graph.hpp>
#include <boost/graph/cuthill_mckee_ordering.hpp>
#include <utility>

#include "geometry/mesh/drop_unused_points.h"
#include "geometry/mesh/element_nodes.h"

namespace delquad {

namespace {

/// Calls visit(nodes) for all nodes of every element.
template <class Visit>
void for_each_node_list(const Mesh& mesh, Visit visit) {
  for (const auto& v : mesh.triangles) visit(v);
  if (mesh.order == 1)
    for (const auto& v : mesh.quads) visit(v);
  else
    for (std::size_t q = 0; q < mesh.quads.size(); ++q) visit(nodes_of_quad(mesh, q));
}

/// Returns the pairs of nodes of common elements, sorted.
std::vector<std::pair<int, int>> neighbours(const Mesh& mesh) {
  std::vector<std::vector<int>> others(mesh.points.size());
  for_each_node_list(mesh, [&](const auto& nodes) {
    for (const int a : nodes)
      for (const int b : nodes)
        if (a != b) others[a].push_back(b);
  });
  std::vector<std::pair<int, int>> pairs;
  for (int a = 0; auto& of_node : others) {
    sort_unique(of_node);
    for (const int b : of_node) pairs.emplace_back(a, b);
    ++a;
  }
  return pairs;
}

void put_in_order(Mesh& mesh, const std::vector<int>& number) {
  std::vector<Vec3> points(mesh.points.size());
  for (std::size_t i = 0; i < points.size(); ++i) points[number[i]] = mesh.points[i];
  mesh.points = std::move(points);
  renumber_nodes(mesh, number);
  const auto renumber = [&](auto& elements) {
    for (auto& nodes : elements)
      for (int& v : nodes) v = number[v];
  };
  renumber(mesh.lines);
  renumber(mesh.triangles);
  renumber(mesh.quads);
  for (auto* nodes : {&mesh.line_nodes, &mesh.quad_nodes})
    for (int& v : *nodes) v = number[v];
}

}  // namespace

int bandwidth(const Mesh& mesh) {
  int most = 0;
  for_each_node_list(mesh, [&](const auto& nodes) {
    const auto [low, high] = std::ranges::minmax(nodes);
    most = std::max(most, high - low);
  });
  return most;
}

void reduce_bandwidth(Mesh& mesh) {
  using Graph = boost::compressed_sparse_row_graph<boost::directedS, boost::no_property, boost::no_property,
                                                   boost::no_property, int, int>;
  const std::vector<std::pair<int, int>> pairs = neighbours(mesh);
  const auto n = static_cast<int>(mesh.points.size());
  const Graph graph(boost::edges_are_sorted, pairs.begin(), pairs.end(), n);
  std::vector<int> order(n);
  std::vector<boost::default_color_type> colours(n);
  const auto index = get(boost::vertex_index, graph);
  boost::cuthill_mckee_ordering(graph, order.rbegin(),
                                boost::make_iterator_property_map(colours.begin(), index),
                                boost::make_out_degree_map(graph));
  std::vector<int> number(n);
  for (int i = 0; i < n; ++i) number[order[i]] = i;
  int after = 0;
  for (const auto& [a, b] : pairs) after = std::max(after, std::abs(number[a] - number[b]));
  if (after < bandwidth(mesh)) put_in_order(mesh, number);
}

}  // namespace delquad
