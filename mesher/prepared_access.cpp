#include <algorithm>
#include <utility>

#include "base/box.h"
#include "features/crosses/size_aware.h"
#include "features/layers/planar_layers.h"
#include "metrics/judgement/soundness.h"
#include "metrics/metrics.h"
#include "metrics/surface/surface_report.h"
#include "patches/prepared.h"

// What others may know of a prepared problem.

namespace delquad {

const Preparation* Prepared::operator->() const { return made_.get(); }
bool Prepared::is_surface() const { return made_->surface != nullptr; }
std::size_t Prepared::n_patches() const { return made_->patches.size(); }
const PatchBoundary& Prepared::patch(std::size_t i) const { return made_->patches.at(i).boundary; }
const Mesh& Prepared::fine() const { return made_->surface->whole().fine; }
const std::vector<SurfaceCut>& Prepared::cuts() const { return made_->surface->cuts; }
std::vector<SharpCorner> Prepared::sharp_corners() const { return made_->sharp_corners(); }
MapReport Prepared::maps() const { return report_maps(maps_of(*made_->surface)); }
double Prepared::row_ends() const { return expected_row_ends(*made_); }

const TriPatch* Prepared::background() const {
  return made_->plane.background ? &made_->plane.background->triangles() : nullptr;
}

std::optional<Cross> Prepared::cross_at(Vec2 u, int& hint) const {
  const BackgroundMesh& background = *made_->plane.background;
  const auto [t, b] = background.locate(u, hint);  // of the place that is nearest
  const TriPatch& tri = background.triangles();
  const auto& v = tri.triangles[t];
  const Vec2 nearest = b[0] * tri.points[v[0]] + b[1] * tri.points[v[1]] + b[2] * tri.points[v[2]];
  constexpr double kRounding = 1e-9;
  if (norm(nearest - u) > kRounding * (norm(u) + norm(tri.points[v[1]] - tri.points[v[0]]))) return {};
  int anywhere = -1;
  return made_->patches[background.triangle_patch()[t]].cross->at(u, anywhere);
}

MeshMetrics Prepared::metrics(const Mesh& made) const {
  return evaluate_metrics(made, made_->size.field.get(), made_->size.asked.get(), made_->settings.options,
                          sorted_half_edges(made), quads_in_layers(*made_, made));
}

MeshResult Prepared::measure(Mesh of_others) const {
  MeshResult result;
  result.mesh = std::move(of_others);
  result.metrics = evaluate_metrics(result.mesh, made_->size.field.get(), made_->size.asked.get(),
                                    made_->settings.options);
  result.soundness = check_elements(*made_, result.mesh);
  result.bad_elsewhere = static_cast<int>(
      std::ranges::count_if(quad_etas(result.mesh), [](double eta) { return eta < kBadEta; }));
  result.prepared = *this;
  return result;
}

}  // namespace delquad
