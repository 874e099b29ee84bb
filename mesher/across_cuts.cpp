#include "mesher/across_cuts.h"

#include <algorithm>
#include <memory>
#include <set>
#include <utility>

#include "mesh/nearest_triangle.h"
#include "mesher/prepare_surface.h"

namespace delquad {
namespace {

constexpr double kNoFeatures = 180;

/// The facets that were given, face by face.
class FacetProjector final : public SurfaceProjector {
 public:
  /// `face_of`: of each face of the model that is projected, the one of `fine`.
  FacetProjector(const Mesh& fine, std::vector<int> face_of) : face_of_(std::move(face_of)) {
    std::vector<std::vector<std::array<int, 3>>> triangles(fine.regions.size());
    for (std::size_t t = 0; t < fine.triangles.size(); ++t)
      triangles[fine.triangle_region[t]].push_back(fine.triangles[t]);
    for (auto& of_face : triangles) {
      // With the face's points only.
      std::vector<int> used;
      for (const auto& v : of_face) used.insert(used.end(), v.begin(), v.end());
      std::ranges::sort(used);
      used.erase(std::unique(used.begin(), used.end()), used.end());
      auto& points = points_.emplace_back();
      for (const int v : used) points.push_back(fine.points[v]);
      for (auto& triangle : of_face)
        for (int& v : triangle) v = static_cast<int>(std::ranges::lower_bound(used, v) - used.begin());
      facets_.push_back(of_face.empty() ? nullptr
                                        : std::make_unique<NearestTriangle>(points, std::move(of_face)));
    }
  }
  Vec3 to_face(int face, const Vec3& x) const override {
    const int own = face_of_[face];
    const NearestTriangle::Found found = facets_[own]->find(x);
    const auto& v = facets_[own]->triangle(found.triangle);
    Vec3 sum;
    for (int k = 0; k < 3; ++k) sum = sum + found.weights[k] * points_[own][v[k]];
    return sum;
  }
  /// Nodes there stay.
  Vec3 to_curve(int, const Vec3& x) const override { return x; }

 private:
  std::vector<int> face_of_;
  std::vector<std::vector<Vec3>> points_;  ///< of each face
  std::vector<std::unique_ptr<NearestTriangle>> facets_;
};

}  // namespace

Mesh run_across_cuts(const PreparedProblem& prepared, const std::vector<const Stage*>& stages,
                     const Mesh& result, StageLog& log) {
  const PreparedSurface& surface = *prepared.surface;
  GivenMesh start{result, prepared.name};
  std::set<int> cuts, on_cuts;
  for (const SurfaceCut& cut : surface.cuts) cuts.insert(cut.curve);
  std::size_t kept = 0;
  for (std::size_t l = 0; l < result.lines.size(); ++l) {
    if (cuts.contains(result.line_curve[l])) {
      on_cuts.insert(result.lines[l].begin(), result.lines[l].end());
      continue;
    }
    start.mesh.lines[kept] = result.lines[l];
    start.mesh.line_curve[kept++] = result.line_curve[l];
  }
  start.mesh.lines.resize(kept);
  start.mesh.line_curve.resize(kept);
  GivenSurface given = make_given_surface(start, kNoFeatures);
  std::set<std::array<double, 3>> places;
  for (const int v : on_cuts) places.insert({result.points[v].x, result.points[v].y, result.points[v].z});
  for (const Vec3& p : given.model.fine.points)
    given.avoided.push_back(places.contains({p.x, p.y, p.z}) ? 1 : 0);
  given.model.projector = std::make_shared<FacetProjector>(surface.model.fine, given.given_region);
  MeshProblem problem;
  problem.name = prepared.name;
  problem.where = prepared.where;
  problem.options = prepared.options;
  problem.max_elements = prepared.max_elements;
  PreparedProblem again =
      prepare_given_surface(problem, std::move(given), start.mesh, prepared.size, [](double) {});
  MeshingState state = begin_meshing(again);
  for (const Stage* stage : stages) run_stage(*stage, again, state);
  for (const auto& [step, time] : again.times) state.log.add_time("other cuts", time);
  state.given.clear();
  state.of_quads.clear();
  RunResult run = finish_meshing(again, prepared.name, std::move(state));
  log.add(run.log);
  return std::move(run.mesh);
}

}  // namespace delquad
