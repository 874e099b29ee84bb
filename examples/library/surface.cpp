// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes a CAD model, or a sphere of triangles.
#include <delquad/mesher.h>

#include <iostream>

/// An octahedron whose triangles are cut into four, several times, on the unit sphere.
delquad::TriangleModel sphere(int times) {
  delquad::Mesh mesh;
  mesh.points = {{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  mesh.triangles = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}, {1, 0, 5}, {2, 1, 5}, {3, 2, 5}, {0, 3, 5}};
  for (; times > 0; --times) {
    std::vector<std::array<int, 3>> finer;
    const auto middle = [&](int a, int b) {
      const delquad::Vec3 m = mesh.points[a] + mesh.points[b];
      mesh.points.push_back(1 / norm(m) * m);
      return static_cast<int>(mesh.points.size()) - 1;
    };
    for (const auto& [a, b, c] : mesh.triangles) {
      const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    mesh.triangles = std::move(finer);
  }
  mesh.regions = {{1, {"ball"}}};
  mesh.triangle_region.assign(mesh.triangles.size(), 0);
  return {std::move(mesh)};
}

int main(int argc, char** argv) {
  delquad::MeshProblem problem;
  if (argc > 1)
    problem.model = delquad::CadModel{argv[1]};
  else
    problem.model = sphere(5);
  problem.size.field = delquad::make_constant_size(argc > 2 ? std::stod(argv[2]) : 0.1);
  delquad::Context context;
  context.threads = 2;
  context.time_limit = 60;
  context.progress = [](const delquad::ProgressReport& report) { std::cout << report.stage << "\n"; };
  try {
    const delquad::MeshResult result = delquad::mesh(problem, "DBCO", context);
    std::cout << result.mesh.quads.size() << " quads, off the surface by at most "
              << result.surface->mesh_to_surface.max << " diagonals\n";
    delquad::write_mesh("surface.vtu", result.mesh);
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
}
