#include "pipeline/size_aware.h"

#include <memory>
#include <vector>

#include "algorithms/insertion/frontal_mesher.h"
#include "algorithms/insertion/point_placement.h"
#include "fields/size_aware_cross_field.h"
#include "mesh/parallel.h"

namespace delquad {
namespace {

/// Edges of the background mesh over delta'. Up to 3, meshes come out alike (d4 by 0.2 over the graded planar
/// cases); the time falls with the square.
constexpr double kCoarser = 2;

class ScaledSize final : public ParametricSize {
 public:
  ScaledSize(const ParametricSize& size, double factor) : size_(size), factor_(factor) {}
  double at(Vec2 u, int& hint) const override { return factor_ * size_.at(u, hint); }

 private:
  const ParametricSize& size_;
  double factor_;
};

std::shared_ptr<const BackgroundMesh> resolve_size(const PreparedPatch& patch) {
  return std::make_shared<BackgroundMesh>(
      mesh_frontal(patch.boundary, *make_l2_frontal(), *patch.cross, ScaledSize(*patch.size, kCoarser)));
}

}  // namespace

void make_crosses_size_aware(PreparedCase& prepared) {
  struct Made {
    std::shared_ptr<const SizeAwareCrossField> field;
    double dislocations_before, dislocations;
  };
  std::vector<Made> made(prepared.patches.size());
  parallel_for(
      made.size(),
      [&](std::size_t i) {
        const PreparedPatch& patch = prepared.patches[i];
        const auto background = resolve_size(patch);
        const auto field = std::make_shared<SizeAwareCrossField>(background, *patch.size, patch.cross);
        made[i] = {field, expected_dislocations(*background, *patch.cross, *patch.size),
                   expected_dislocations(*background, *field, *patch.size)};
      },
      [&](std::size_t i) { return static_cast<double>(prepared.patches[i].boundary.points.size()); });

  prepared.singularities.clear();
  prepared.index_sum_and_expected = {0, 0};
  prepared.dislocations = {0, 0};
  for (std::size_t i = 0; i < made.size(); ++i) {
    const auto& [field, dislocations_before, dislocations] = made[i];
    prepared.patches[i].cross = field;
    prepared.index_sum_and_expected->first += field->index_sum();
    prepared.index_sum_and_expected->second += 4 * field->euler_characteristic();
    prepared.dislocations->first += dislocations_before;
    prepared.dislocations->second += dislocations;
    if (!prepared.background) continue;  // singularities of surfaces would be points of parameter planes
    for (const Singularity& s : field->singularities()) prepared.singularities.push_back(s);
  }
}

}  // namespace delquad
