// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/mesh/outline.h"

#include <algorithm>

#include "geometry/mesh/half_edges.h"

namespace delquad {

bool holds_surface(const Mesh& mesh) {
  const auto in_space = [&](const auto& elements) {
    return std::ranges::any_of(elements, [&](const auto& element) {
      return std::ranges::any_of(element,
                                 [&](int v) { return mesh.points[v].z != mesh.points[elements[0][0]].z; });
    });
  };
  return in_space(mesh.triangles) || in_space(mesh.quads);
}

Mesh outline(const Mesh& mesh) {
  Mesh result;
  result.points = mesh.points;
  result.curves = mesh.curves;
  if (!mesh.lines.empty()) {
    result.lines = mesh.lines;
    result.line_curve = mesh.line_curve;
    return result;
  }
  result.curves = {{1, {}}};
  for_each_edge(sorted_half_edges(mesh), [&](std::span<const HalfEdge> edge) {
    if (edge.size() == 1) result.lines.push_back(edge[0].run());
  });
  result.line_curve.assign(result.lines.size(), 0);
  return result;
}

}  // namespace delquad
