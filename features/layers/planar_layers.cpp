#include "features/layers/planar_layers.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "base/text.h"
#include "delquad/error.h"
#include "features/grids/grids.h"
#include "features/layers/add_layers.h"
#include "features/sizes/fine_spots.h"
#include "geometry/mesh/entity_names.h"

namespace delquad {
namespace {

/// Edges of fronts below this part of the size make it less.
constexpr double kShortFront = 0.8;
/// Beyond this, solvers see the jump from the last layer to the quads beside it.
constexpr double kLargeJump = 4;

std::vector<FineSpot> short_boundary_edges(const PlanarDomain& domain, const SizeField& size) {
  const double z = domain.boundary.points[0].z;
  std::vector<FineSpot> spots;
  int hint = -1;
  for (const PatchBoundary& patch : domain.patches)
    for (const auto& [i, j] : patch.edges) {
      const Vec3 a{patch.points[i].x, patch.points[i].y, z}, b{patch.points[j].x, patch.points[j].y, z};
      const double length = norm(b - a);
      if (length < kShortFront * size.at(0.5 * (a + b), hint)) spots.push_back({a, b, length, length});
    }
  return spots;
}

void warn_of_layers(const MeshProblem& problem, const LayerReport& layers, std::vector<Warning>& warnings) {
  const std::string& where = problem.layers[0].where;
  if (layers.count.least_scale < 1)
    warnings.emplace_back(
        fmt::format("{}: layers are lower where there is no room for them, down to {:.2g} of their height at "
                    "{} on {}",
                    where, layers.count.least_scale, show_point(layers.least_at), layers.least_on));
  if (layers.largest_jump > kLargeJump)
    warnings.emplace_back(fmt::format(
        "{}: edges on the last layer are up to {:.3g} times as long as it is high, on {}: more layers, or "
        "a smaller size there, would help",
        where, layers.largest_jump, layers.jump_on));
}

/// Regions that got layers are no grids any more. Throws InputError where they were asked to be.
void drop_grids(const MeshProblem& problem, const LayerReport& layers, PlanarDomain& domain) {
  std::erase_if(domain.mapped, [&](const auto& mapped) {
    if (std::ranges::find(layers.patches, mapped.patch) == layers.patches.end()) return false;
    if (mapped.is_asked)
      throw InputError(fmt::format(
          "{}: layers stand in the grid '{}' ({}), or end on its sides: expected the one or the other, or "
          "layers 'into' other regions",
          problem.layers[0].where, region_label(domain.boundary.regions[domain.patch_region[mapped.patch]]),
          problem.mapped.where));
    return true;
  });
}

/// Of what layers leave of the patches.
std::shared_ptr<const BackgroundMesh> mesh_rest(const MeshProblem& problem, const PlanarDomain& domain) {
  try {
    return std::make_shared<BackgroundMesh>(domain.patches);
  } catch (const InputError& error) {
    std::vector<std::string> on;
    for (const LayerSpec& layer : problem.layers) on.insert(on.end(), layer.on.begin(), layer.on.end());
    throw InputError(fmt::format("{}: there is no place for the layers on '{}': beside them, {}",
                                 problem.layers[0].where, fmt::join(on, "', '"), error.what()));
  }
}

}  // namespace

void put_layers(const MeshProblem& problem, PlanarDomain& domain, PreparedProblem& p) {
  LayerReport report = add_layers(domain, problem.layers, static_cast<double>(p.settings.max_elements));
  drop_grids(problem, report, domain);
  p.plane.background = mesh_rest(problem, domain);
  report.outlines = std::move(domain.outlines);
  warn_of_layers(problem, report, p.warnings);
  p.layers = std::make_shared<LayerReport>(std::move(report));
  std::vector<FineSpot> fine = short_boundary_edges(domain, *p.size.field);
  if (fine.empty()) return;
  p.size.adapted_to.push_back("layers");
  if (!p.size.asked) p.size.asked = p.size.field;
  p.size.field = finer_near(p.size.field, std::move(fine));
}

std::vector<char> quads_in_layers(const PreparedProblem& prepared, const Mesh& mesh) {
  std::vector<int> left(prepared.boundary.regions.size(), 0);
  for (const int region : prepared.boundary.quad_region) ++left[region];
  std::vector<char> in_layers;
  for (const int region : mesh.quad_region)
    in_layers.push_back(region < static_cast<int>(left.size()) && left[region]-- > 0);
  return in_layers;
}

}  // namespace delquad
