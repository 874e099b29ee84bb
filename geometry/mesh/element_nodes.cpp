// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/mesh/element_nodes.h"

#include <algorithm>

namespace delquad {

std::vector<int> side_places(int order, int side) {
  const int row = order + 1;
  std::vector<int> places;
  for (int k = 1; k < order; ++k) {
    const int along[] = {k, order + k * row, order * row + order - k, (order - k) * row};
    places.push_back(along[side]);
  }
  return places;
}

std::vector<int> inner_places(int order) {
  std::vector<int> places;
  for (int j = 1; j < order; ++j)
    for (int i = 1; i < order; ++i) places.push_back(j * (order + 1) + i);
  return places;
}

std::vector<int> gmsh_places(int order) {
  if (order == 0) return {0};
  const int row = order + 1;
  std::vector<int> places{0, order, order * row + order, order * row};
  for (int side = 0; side < 4; ++side)
    for (const int place : side_places(order, side)) places.push_back(place);
  if (order > 1)
    for (const int place : gmsh_places(order - 2))
      places.push_back((place / (order - 1) + 1) * row + place % (order - 1) + 1);
  return places;
}

std::vector<int> vtk_places(int order) {
  const int row = order + 1;
  std::vector<int> places{0, order, order * row + order, order * row};
  for (int side = 0; side < 4; ++side) {
    std::vector<int> along = side_places(order, side);
    if (side >= 2) std::ranges::reverse(along);
    places.insert(places.end(), along.begin(), along.end());
  }
  const std::vector<int> inner = inner_places(order);
  places.insert(places.end(), inner.begin(), inner.end());
  return places;
}

std::vector<int> nodes_of_quad(const Mesh& mesh, std::size_t quad) {
  const int p = mesh.order, row = p + 1;
  std::vector<int> nodes(static_cast<std::size_t>(row) * row);
  const auto& v = mesh.quads[quad];
  nodes[0] = v[0];
  nodes[p] = v[1];
  nodes[p * row + p] = v[2];
  nodes[p * row] = v[3];
  if (p == 1) return nodes;
  const std::size_t each = static_cast<std::size_t>(row) * row - 4;
  auto next = mesh.quad_nodes.begin() + static_cast<std::ptrdiff_t>(quad * each);
  for (int side = 0; side < 4; ++side)
    for (const int place : side_places(p, side)) nodes[place] = *next++;
  for (const int place : inner_places(p)) nodes[place] = *next++;
  return nodes;
}

std::vector<int> nodes_of_quad(const Mesh& mesh, std::size_t quad, const std::vector<int>& places) {
  const std::vector<int> square = nodes_of_quad(mesh, quad);
  std::vector<int> nodes;
  for (const int place : places) nodes.push_back(square[place]);
  return nodes;
}

std::vector<int> nodes_ends_first(const Mesh& mesh, std::size_t line) {
  std::vector<int> nodes = nodes_of_line(mesh, line);
  std::rotate(nodes.begin() + 1, nodes.end() - 1, nodes.end());
  return nodes;
}

std::vector<int> nodes_of_line(const Mesh& mesh, std::size_t line) {
  std::vector<int> nodes{mesh.lines[line][0]};
  const auto each = static_cast<std::size_t>(mesh.order - 1);
  for (std::size_t k = 0; k < each; ++k) nodes.push_back(mesh.line_nodes[line * each + k]);
  nodes.push_back(mesh.lines[line][1]);
  return nodes;
}

int order_of_line(std::size_t n_nodes) {
  return n_nodes >= 2 && n_nodes <= kMostOrder + 1 ? static_cast<int>(n_nodes) - 1 : 0;
}

int order_of_quad(std::size_t n_nodes) {
  constexpr std::size_t kEight = 8;
  if (n_nodes == kEight) return 2;
  for (int order = 1; order <= kMostOrder; ++order)
    if (n_nodes == static_cast<std::size_t>((order + 1) * (order + 1))) return order;
  return 0;
}

bool takes_order(Mesh& mesh, int order) {
  if (mesh.lines.empty() && mesh.triangles.empty() && mesh.quads.empty()) mesh.order = order;
  return mesh.order == order;
}

std::string other_order(int order, int of_mesh) {
  return "an element of order " + std::to_string(order) + " beside elements of order " +
         std::to_string(of_mesh) + ": expected one order for all";
}

void add_line(Mesh& mesh, std::span<const int> nodes, int curve) {
  mesh.lines.push_back({nodes[0], nodes[1]});
  mesh.line_nodes.insert(mesh.line_nodes.end(), nodes.begin() + 2, nodes.end());
  mesh.line_curve.push_back(curve);
}

Vec3 middle_of_eight(const std::array<Vec3, 4>& corners, const std::array<Vec3, 4>& sides) {
  return 0.5 * (sides[0] + sides[1] + sides[2] + sides[3]) -
         0.25 * (corners[0] + corners[1] + corners[2] + corners[3]);
}

void add_quad(Mesh& mesh, std::span<const int> nodes, const std::vector<int>& places, int region) {
  const int p = mesh.order, row = p + 1;
  std::vector<int> square(places.size(), static_cast<int>(mesh.points.size()));
  for (std::size_t k = 0; k < nodes.size(); ++k) square[places[k]] = nodes[k];
  if (nodes.size() < places.size()) {
    const auto at = [&](std::size_t k) { return mesh.points[nodes[k]]; };
    mesh.points.push_back(middle_of_eight({at(0), at(1), at(2), at(3)}, {at(4), at(5), at(6), at(7)}));
  }
  mesh.quads.push_back({square[0], square[p], square[p * row + p], square[p * row]});
  for (int side = 0; side < 4; ++side)
    for (const int place : side_places(p, side)) mesh.quad_nodes.push_back(square[place]);
  for (const int place : inner_places(p)) mesh.quad_nodes.push_back(square[place]);
  mesh.quad_region.push_back(region);
}

Vec3 value_on_line(std::span<const Vec3> nodes, double t) {
  const int n = static_cast<int>(nodes.size()) - 1;
  Vec3 sum;
  for (int i = 0; i <= n; ++i) {
    double weight = 1;
    for (int k = 0; k <= n; ++k)
      if (k != i) weight *= (t * n - k) / (i - k);
    sum = sum + weight * nodes[i];
  }
  return sum;
}

std::vector<int> nodes_around(const Mesh& mesh, std::size_t quad) {
  const std::vector<int> square = nodes_of_quad(mesh, quad);
  std::vector<int> nodes;
  for (int side = 0; side < 4; ++side) {
    nodes.push_back(mesh.quads[quad][side]);
    for (const int place : side_places(mesh.order, side)) nodes.push_back(square[place]);
  }
  return nodes;
}

int drawn_pieces(const Mesh& mesh) {
  constexpr int kCurved = 8;
  return mesh.order == 1 ? 1 : kCurved;
}

std::vector<Vec3> outline_of_quad(const Mesh& mesh, std::size_t quad) {
  const int pieces = drawn_pieces(mesh), p = mesh.order;
  std::vector<Vec3> around, outline;
  for (const int v : nodes_around(mesh, quad)) around.push_back(mesh.points[v]);
  around.push_back(around[0]);
  for (int side = 0; side < 4; ++side) {
    const std::span<const Vec3> along(around.data() + side * p, static_cast<std::size_t>(p) + 1);
    for (int k = 0; k < pieces; ++k) outline.push_back(value_on_line(along, static_cast<double>(k) / pieces));
  }
  return outline;
}

std::vector<Vec3> outline_of_line(const Mesh& mesh, std::size_t line) {
  const int pieces = drawn_pieces(mesh);
  std::vector<Vec3> along, outline;
  for (const int v : nodes_of_line(mesh, line)) along.push_back(mesh.points[v]);
  for (int k = 0; k <= pieces; ++k) outline.push_back(value_on_line(along, static_cast<double>(k) / pieces));
  return outline;
}

}  // namespace delquad
