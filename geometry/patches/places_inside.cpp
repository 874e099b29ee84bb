// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/patches/places_inside.h"

#include <cassert>
#include <limits>

#include "base/cancel.h"
#include "base/parallel.h"

namespace delquad {

namespace {

/// Least shift that counts, over a side at the node.
constexpr double kSmall = 0.05;
/// Number of sweeps, each of which carries shifts one side further.
constexpr int kInsideSweeps = 10;

class Shifts {
 public:
  Shifts(const SurfacePatch& patch, const Mesh& fine, std::span<const Vec2> points,
         const std::vector<std::array<int, 2>>& sides, const std::vector<Vec3>& nodes)
      : points_(points), sides_(sides), n_boundary_(patch.boundary.point_node.size()), shift_(points.size()) {
    int hint = -1;
    for (std::size_t i = 0; i < n_boundary_; ++i)
      shift_[i] = nodes[patch.boundary.point_node[i]] - fine_place(patch, fine, points[i], hint);
    for (const auto& [a, b] : sides) {
      const auto node = [&](int i) { return nodes[patch.boundary.point_node[i]]; };
      for (const int i : {a, b}) {
        if (i >= static_cast<int>(n_boundary_) || norm(shift_[i]) == 0) continue;
        const int other = a + b - i;
        const double length = other < static_cast<int>(n_boundary_)
                                  ? norm(node(other) - node(i))
                                  : norm(fine_place(patch, fine, points[other], hint) - node(i) + shift_[i]);
        if (norm(shift_[i]) > kSmall * length) matter_ = true;
      }
    }
  }

  bool matter() const { return matter_; }

  void spread() {
    std::vector<std::vector<int>> around(points_.size());
    for (const auto& [a, b] : sides_) around[a].push_back(b), around[b].push_back(a);
    for (int sweep = 0; sweep < kInsideSweeps; ++sweep) {
      check_cancelled();
      for (std::size_t i = n_boundary_; i < points_.size(); ++i) {
        Vec3 sum;
        double weights = 0;
        for (const int j : around[i]) {
          const Vec2 d = points_[j] - points_[i];
          const double weight = 1 / std::max(dot(d, d), 1e-300);
          sum = sum + weight * shift_[j];
          weights += weight;
        }
        if (weights > 0) shift_[i] = (1 / weights) * sum;
      }
    }
  }

  Vec3 at(std::size_t i) const { return shift_[i]; }

 private:
  std::span<const Vec2> points_;
  const std::vector<std::array<int, 2>>& sides_;
  std::size_t n_boundary_;
  std::vector<Vec3> shift_;
  bool matter_ = false;
};

}  // namespace

std::vector<Vec3> places_inside(const SurfacePatch& patch, const SurfaceModel& model,
                                std::span<const Vec2> points, const std::vector<std::array<int, 2>>& sides,
                                const std::vector<Vec3>& nodes) {
  std::vector<Vec3> places;
  assert(points.size() >= patch.boundary.point_node.size());
  int hint = -1;
  const std::size_t n_boundary = patch.boundary.point_node.size();
  Shifts shifts(patch, model.fine, points, sides, nodes);
  if (model.projector && shifts.matter()) {
    shifts.spread();
    for (std::size_t i = n_boundary; i < points.size(); ++i) {
      check_cancelled();
      places.push_back(model.projector->to_face(
          patch.map.face, fine_place(patch, model.fine, points[i], hint) + shifts.at(i)));
    }
  } else {
    for (std::size_t i = n_boundary; i < points.size(); ++i) {
      check_cancelled();
      places.push_back(lift(patch, model, points[i], hint));
    }
  }
  return places;
}

std::vector<const FlatPatch*> maps_of(const SurfaceSetup& surface) {
  std::vector<const FlatPatch*> maps;
  for (const SurfacePatch& patch : surface.domain.patches) maps.push_back(&patch.map);
  return maps;
}

std::vector<Vec3> places_inside(const MeshingSetup& prepared, std::size_t patch, const PatchMesh& mesh,
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
  const SurfaceSetup& surface = *prepared.surface;
  return places_inside(surface.domain.patches[patch], surface.model, points, sides, nodes);
}

StageInput input_of(const AllPatches& all, std::size_t patch) {
  const PatchSetup& p = all.prepared.patches.at(patch);
  return {p.boundary, *p.cross, *p.size, all.options, std::numeric_limits<long long>::max()};
}

const std::vector<Vec3>& node_places(const AllPatches& all) { return all.nodes.points; }

void place_inside(const AllPatches& all) {
  assert(all.left_out.size() == all.patches.size());
  parallel_for(
      all.patches.size(),
      [&](std::size_t i) {
        PatchMesh& patch = all.patches[i];
        if (patch.form != PatchForm::kQuads || all.left_out[i] || !patch.inside.empty()) return;
        const FaceScope face = patch_scope(all.prepared, i);
        patch.inside = places_inside(all.prepared, i, patch, all.nodes.points);
      },
      [&](std::size_t i) { return static_cast<double>(all.patches[i].quads.points.size()); });
}

}  // namespace delquad
