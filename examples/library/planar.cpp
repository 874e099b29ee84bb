// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes a plate with a hole with quads only, and writes the mesh for a solver.
#include <delquad/mesher.h>

#include <iostream>

int main() {
  delquad::MeshProblem problem;
  problem.model = delquad::polygons({{{0, 0}, {4, 0}, {4, 3}, {0, 3}}, {{1, 1}, {2, 1}, {2, 2}, {1, 2}}});
  problem.size.field = delquad::make_constant_size(0.1);

  const delquad::MeshResult result = delquad::mesh(problem, "DBCO");

  std::cout << result.mesh.quads.size() << " quads, eta " << result.metrics.values.at("eta_mean") << "\n";
  delquad::write_mesh("plate.msh", result.mesh);
}
