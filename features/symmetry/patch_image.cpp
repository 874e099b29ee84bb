#include "features/symmetry/planar_symmetry.h"

#include <algorithm>
#include <utility>

namespace delquad {
namespace {

/// Points inside follow the boundary's, in the master's order.
std::vector<Vec2> image_points(const std::vector<Vec2>& of, int n_boundary, const PatchBoundary& boundary,
                               const PatchImage& image) {
  std::vector<Vec2> points = boundary.points;
  for (auto p = of.begin() + n_boundary; p != of.end(); ++p) points.push_back(image.motion(*p));
  return points;
}

}  // namespace

PatchMesh image_of(const PatchMesh& master, const PatchBoundary& boundary, const PatchImage& image) {
  PatchMesh mesh = master;
  const int n = static_cast<int>(boundary.points.size());
  const auto turn = [&](auto& elements) {
    for (auto& element : elements) {
      for (int& v : element)
        if (v < n) v = image.point[v];
      if (image.is_mirrored) std::reverse(element.begin() + 1, element.end());
    }
  };
  if (mesh.form == PatchForm::kTriangles) {
    mesh.triangles.points = image_points(master.triangles.points, n, boundary, image);
    turn(mesh.triangles.triangles);
    if (image.is_mirrored)
      for (auto& across : mesh.triangles.neighbours) std::swap(across[1], across[2]);
  } else if (mesh.form == PatchForm::kQuads) {
    mesh.quads.points = image_points(master.quads.points, n, boundary, image);
    turn(mesh.quads.quads);
    turn(mesh.quads.triangles);
  }
  mesh.inside.clear();
  return mesh;
}

void move_image_nodes(const PreparedProblem& prepared, const PatchImage& image, std::vector<Vec3>& points) {
  const auto &from = prepared.patches[image.master].boundary.point_node,
             &to = prepared.patches[image.patch].boundary.point_node;
  for (std::size_t k = 0; k < from.size(); ++k) {
    const Vec3 &now = points[from[k]], &before = prepared.boundary.points[from[k]];
    if (now.x == before.x && now.y == before.y) continue;
    const Vec2 place = image.motion({now.x, now.y});
    points[to[image.point[k]]] = {place.x, place.y, now.z};
  }
}

}  // namespace delquad
