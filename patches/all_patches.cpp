#include "patches/all_patches.h"

#include <array>

#include "patches/places_inside.h"

namespace delquad {

std::vector<const FlatPatch*> maps_of(const PreparedSurface& surface) {
  std::vector<const FlatPatch*> maps;
  for (const SurfacePatch& patch : surface.domain.patches) maps.push_back(&patch.map);
  return maps;
}

std::vector<Vec3> places_inside(const PreparedProblem& prepared, std::size_t patch, const PatchMesh& mesh,
                                const std::vector<Vec3>& nodes) {
  const bool of_triangles = mesh.form == PatchForm::kTriangles;
  const std::vector<Vec2>& points = of_triangles ? mesh.triangles.points : mesh.quads.points;
  if (!prepared.surface) {
    std::vector<Vec3> lifted;
    int hint = -1;
    for (std::size_t i = prepared.patches[patch].boundary.points.size(); i < points.size(); ++i)
      lifted.push_back(prepared.patches[patch].lift(points[i], hint));
    return lifted;
  }
  std::vector<std::array<int, 2>> sides;
  const auto add_sides = [&](const auto& elements) {
    for (const auto& v : elements)
      for (std::size_t k = 0; k < v.size(); ++k) sides.push_back({v[k], v[(k + 1) % v.size()]});
  };
  add_sides(of_triangles ? mesh.triangles.triangles : mesh.quads.triangles);
  add_sides(mesh.quads.quads);
  const PreparedSurface& surface = *prepared.surface;
  return places_inside(surface.domain.patches[patch], surface.model, points, sides, nodes);
}

}  // namespace delquad
