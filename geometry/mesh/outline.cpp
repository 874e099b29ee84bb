#include "geometry/mesh/outline.h"

#include <algorithm>
#include <array>
#include <vector>

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
  std::vector<std::array<int, 4>> sides;  // lower node, upper node, then as the element runs
  const auto add = [&](int a, int b) { sides.push_back({std::min(a, b), std::max(a, b), a, b}); };
  for (const auto& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) add(t[k], t[(k + 1) % 3]);
  for (const auto& q : mesh.quads)
    for (int k = 0; k < 4; ++k) add(q[k], q[(k + 1) % 4]);
  std::sort(sides.begin(), sides.end());
  const auto same = [&](std::size_t i, std::size_t j) {
    return j < sides.size() && sides[i][0] == sides[j][0] && sides[i][1] == sides[j][1];
  };
  result.curves = {{1, {}}};
  for (std::size_t i = 0; i < sides.size();) {
    std::size_t next = i + 1;
    while (same(i, next)) ++next;
    if (next == i + 1) result.lines.push_back({sides[i][2], sides[i][3]});
    i = next;
  }
  result.line_curve.assign(result.lines.size(), 0);
  return result;
}

}  // namespace delquad
