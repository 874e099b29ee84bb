#include "mesh/element_nodes.h"

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

std::vector<Vec3> outline_of_quad(const Mesh& mesh, std::size_t quad) {
  constexpr int kPieces = 8;  // of a curved side
  const int pieces = mesh.order == 1 ? 1 : kPieces;
  const std::vector<int> nodes = nodes_of_quad(mesh, quad);
  std::vector<Vec3> outline;
  for (int side = 0; side < 4; ++side) {
    std::vector<Vec3> along{mesh.points[mesh.quads[quad][side]]};
    for (const int place : side_places(mesh.order, side)) along.push_back(mesh.points[nodes[place]]);
    along.push_back(mesh.points[mesh.quads[quad][(side + 1) % 4]]);
    for (int k = 0; k < pieces; ++k) outline.push_back(value_on_line(along, static_cast<double>(k) / pieces));
  }
  return outline;
}

}  // namespace delquad
