#include "patches/all_patches.h"

#include <array>

#include "base/parallel.h"
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
  const std::vector<Vec2>& points = points_of(mesh);
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

void place_inside(const AllPatches& all) {
  parallel_for(
      all.patches.size(),
      [&](std::size_t i) {
        PatchMesh& patch = all.patches[i];
        if (patch.form != PatchForm::kQuads || all.left_out[i] || !patch.inside.empty()) return;
        const DoingFace face = doing_patch(all.prepared, i);
        patch.inside = places_inside(all.prepared, i, patch, all.nodes.points);
      },
      [&](std::size_t i) { return static_cast<double>(all.patches[i].quads.points.size()); });
}

}  // namespace delquad
