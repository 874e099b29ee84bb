// SPDX-License-Identifier: GPL-3.0-or-later
// Your own sizes and directions: by a function of many points at a time, and by values at nodes.
#include <delquad/mesher.h>

#include <iostream>

int main() {
  delquad::MeshProblem problem;
  delquad::PlanarModel disc;
  disc.curves = {{delquad::make_circle({0, 0}, 1), "wall", ""}};
  disc.loops = {{{0}, "disc", ""}};
  problem.model = disc;
  problem.size.function = [](std::span<const delquad::Vec3> points, std::span<double> delta) {
    for (std::size_t i = 0; i < points.size(); ++i) delta[i] = 0.02 + 0.08 * norm(points[i]);
  };
  problem.cross.kind = delquad::CrossKind::kField;
  problem.cross.function = [](std::span<const delquad::Vec2> points, std::span<double> theta) {
    for (std::size_t i = 0; i < points.size(); ++i) theta[i] = 0.2 * points[i].x;
  };
  const delquad::MeshResult first = delquad::mesh(problem, "DB");

  // The size for a second mesh from the first one: half of the mean length of the sides around a node.
  std::vector<double> sum(first.mesh.points.size()), count(sum.size());
  for (const auto& q : first.mesh.quads)
    for (int k = 0; k < 4; ++k) {
      const int a = q[k], b = q[(k + 1) % 4];
      const double length = norm(first.mesh.points[b] - first.mesh.points[a]);
      for (const int v : {a, b}) sum[v] += length, count[v] += 1;
    }
  for (std::size_t v = 0; v < sum.size(); ++v) sum[v] /= 2 * count[v];
  problem.size = {};
  problem.size.field = delquad::make_nodal_size(first.mesh, sum);
  const delquad::MeshResult second = delquad::mesh(problem, "DB");
  std::cout << first.mesh.quads.size() << " quads, then " << second.mesh.quads.size() << "\n";
}
