// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <variant>

#include "algorithms/fields/fields.h"
#include "algorithms/fields/sampled_fields.h"
#include "delquad/error.h"
#include "features/crosses/made_crosses.h"
#include "features/crosses/size_aware.h"
#include "features/curves/compose_size.h"
#include "features/given/given_domain.h"
#include "features/given/given_worst.h"
#include "features/given/named_domain.h"
#include "features/grids/grids.h"
#include "features/layers/add_layers.h"
#include "features/metric/metric_plane.h"
#include "features/seed/perturb.h"
#include "features/sizes/curve_options.h"
#include "features/sizes/fine_spots.h"
#include "features/sizes/named_parts.h"
#include "features/sizes/size_warnings.h"
#include "features/thin/cut_wedges.h"
#include "geometry/patches/narrow_places.h"
#include "geometry/planar/check_lines.h"
#include "mesher/prepare.h"
#include "mesher/runner.h"
#include "metrics/judgement/criteria.h"

namespace delquad {
namespace {

/// Sets background and size of a domain whose lines are kept. `own` makes the size in place of a missing
/// base.
void set_kept_size(const SizeSpec& spec, const PlanarDomain& domain, MeshingSetup& p,
                   const std::function<std::shared_ptr<const SizeField>()>& own) {
  p.plane.background = std::make_shared<BackgroundMesh>(domain.patches);
  p.size.field = base_size(spec, {Box<Vec3>::around(domain.boundary.points)}, p.warnings, own);
  if (!spec.named.empty()) {
    const NamedParts parts(domain);
    warn_of_ineffective_sizes(spec.named, parts, *p.size.field, p.warnings);
    p.size.field = finer_near(p.size.field, parts.spots(spec.named));
  }
  if (spec.gradation > 0) p.size.field = limit_gradation(p.size.field, p.plane.background, spec.gradation);
}

PlanarDomain prepare_lines(const MeshProblem& problem, const LineModel& model, MeshingSetup& p) {
  const Mesh& mesh = model.mesh;
  if (mesh.lines.empty())
    throw InputError(model.source + ": holds no line elements: expected the boundary of a planar domain");
  if (!mesh.triangles.empty() || !mesh.quads.empty())
    p.warnings.push_back(
        fmt::format("{}: {} triangles and {} quads are left out: only lines count as boundary", model.source,
                    mesh.triangles.size(), mesh.quads.size()));
  PlanarDomain domain = make_named_domain(mesh, model.surfaces, model.source);
  set_kept_size(problem.size, domain, p,
                [&] { return make_boundary_size(p.plane.background, domain.boundary); });
  if (has_single_points(mesh)) {
    domain = make_named_domain(mesh, model.surfaces, model.source, p.size.field.get());
    p.plane.background = std::make_shared<BackgroundMesh>(domain.patches);
  }
  return domain;
}

/// Returns the domain of a given mesh. `given` receives the elements of each patch.
PlanarDomain prepare_given(const MeshProblem& problem, const GivenMesh& model, MeshingSetup& p,
                           std::vector<QuadPatch>& given) {
  p.warnings.insert(p.warnings.end(), model.notes.begin(), model.notes.end());
  GivenDomain domain = make_given_domain(model);
  p.warnings.insert(p.warnings.end(), domain.warnings.begin(), domain.warnings.end());
  set_kept_size(problem.size, domain.domain, p, [&]() -> std::shared_ptr<const SizeField> {
    if (problem.size.from_boundary)
      return make_boundary_size(p.plane.background, edges_of_patches(domain.domain));
    return make_nodal_size(model.mesh, sizes_of_elements(model.mesh, model.source));
  });
  for (const std::string& line : odd_boundaries(domain.domain))
    p.warnings.push_back({"regions with an odd number of boundary edges", 0, line});
  given = std::move(domain.elements);
  return std::move(domain.domain);
}

/// Warns if the indices of a cross field do not add up to the Euler characteristic.
void check_index_sum(const MeshProblem& problem, MeshingSetup& p) {
  const auto [sum, expected] = *p.crosses.index_sum_and_expected;
  if (sum == expected) return;
  p.warnings.push_back(
      fmt::format("{}: the indices of the cross field add up to {}/4, but the domain's Euler "
                  "characteristic is {}/4",
                  problem.name, sum, expected));
}

/// Returns the cross field of the whole domain; null: patches get their own, see make_crosses_size_aware().
std::shared_ptr<const CrossField> make_cross(const MeshProblem& problem,
                                             const std::shared_ptr<const CrossField>& given,
                                             MeshingSetup& p) {
  const CrossSpec& cross = problem.cross;
  if (given) return problem.seed == 0 ? given : rotated(given, Rotation::by_seed(problem.seed));
  if (cross.kind == CrossKind::kSizeAware) return nullptr;
  auto field = std::make_shared<HarmonicCrossField>(p.plane.background);
  for (const Singularity& s : field->singularities())
    p.crosses.singularities.push_back({{s.at.x, s.at.y, 0}, s.index});
  p.crosses.index_sum_and_expected = {field->index_sum(), 4 * field->euler_characteristic()};
  return field;
}

/// Rotates domain, elements and size by an angle from the problem's seed.
void turn(const MeshProblem& problem, PlanarDomain& domain, std::vector<QuadPatch>& given, MeshingSetup& p) {
  const Rotation rotation = Rotation::by_seed(problem.seed);
  rotate(rotation, domain);
  for (QuadPatch& patch : given)
    for (Vec2& point : patch.points) point = rotation(point);
  p.plane.background = std::make_shared<BackgroundMesh>(domain.patches);
  for (auto* size : {&p.size.field, &p.size.asked, &p.size.curved})
    if (*size) *size = rotated(std::move(*size), rotation);
}

class PlanarSteps final : public ModelSteps {
 public:
  PlanarSteps(const MeshProblem& problem, const RetryHints& hints)
      : problem_(problem),
        hints_(hints),
        model_(std::get_if<PlanarModel>(&problem.model)),
        lines_(std::get_if<LineModel>(&problem.model)) {}

  void read(MeshingSetup&) override {}
  bool is_surface() const override { return false; }

  void mesh_curves(MeshingSetup& p) override {
    domain_ = make_domain(p);
    if (domain_.boundary.unit.empty()) domain_.boundary.unit = problem_.surface.unit;
    for (const std::string& note : domain_.notes) p.warnings.emplace_back(note);
    if (model_ != nullptr || lines_ != nullptr) warn_of_gaps(domain_, p.warnings);
    if (!problem_.layers.empty()) {
      const std::vector<LocalSize> fine = put_layers(problem_.layers, problem_.mapped, domain_, p);
      if (!fine.empty() && !p.size.asked) p.size.asked = p.size.field;
      if (!fine.empty()) p.size.field = finer_near(p.size.field, fine);
    } else if (model_ != nullptr && curve_options(problem_.options).thin_rows) {
      cut_wedges(domain_);
    }
    if (lines_ != nullptr)
      for (const std::string& line : odd_boundaries(domain_))
        p.warnings.push_back({"regions with an odd number of boundary edges", 0, line});
    p.size.expected_quads = expected_quads(p.plane.background->triangles(), *p.size.field) +
                            (p.layers ? p.layers->count.quads : 0);
    check_count(p.size.expected_quads, problem_);
    warn_of_large_size(*p.size.field, domain_.boundary, p.warnings);
    if (model_ != nullptr && !p.metric_plane)
      warn_of_coarse_turns(*model_, domain_, problem_.size, p.size.asked ? *p.size.asked : *p.size.field,
                           p.warnings);
    given_cross_ = given_cross(problem_.cross, domain_.boundary, p);
    auto shapes = domain_.curve_shapes;
    if (problem_.seed != 0) turn(problem_, domain_, given_, p);
    if (model_ != nullptr) seed_narrow(agreement_of(problem_, hints_));
    p.boundary = std::move(domain_.boundary);
    p.plane.curve_places = std::move(domain_.places);
    p.plane.outlines = std::move(domain_.outlines);
    if (!p.metric_plane) p.plane.pieces = std::move(domain_.pieces);
    p.plane.curve_shapes =
        p.metric_plane ? true_curves(*p.metric_plane, std::move(shapes)) : std::move(domain_.curve_shapes);
  }

  void make_patches(MeshingSetup& p) override {
    const auto cross = make_cross(problem_, given_cross_, p);
    const double z = p.boundary.points[0].z;
    const auto size = std::make_shared<PlanarSize>(p.size.field, z);
    size->limits = p.settings.limits = limits_of(problem_.criteria, requested_size(p), p.boundary.points);
    for (std::size_t i = 0; i < domain_.patches.size(); ++i)
      p.patches.push_back({std::move(domain_.patches[i]),
                           domain_.patch_region[i],
                           cross,
                           size,
                           [z](Vec2 u, int&) {
                             return Vec3{u.x, u.y, z};
                           },
                           {}});
    for (std::size_t i = 0; i < given_.size(); ++i) p.patches[i].given = std::move(given_[i]);
    if (std::ranges::any_of(p.patches, [](const auto& patch) { return !patch.given.quads.empty(); })) {
      std::vector<PatchMesh> given;
      for (const PatchSetup& patch : p.patches) given.push_back({PatchForm::kQuads, {}, patch.given, {}});
      const std::vector<char> none(p.boundary.regions.size(), 0);
      p.given_worst = worst_of_given(assemble(p, p.boundary.points, given, none), true, *p.size.field);
    }
    if (problem_.cross.kind == CrossKind::kSizeAware) make_crosses_size_aware(p);
    if (problem_.cross.kind == CrossKind::kMade) use_made_crosses(problem_.cross, p);
    if (problem_.cross.kind == CrossKind::kMetric)
      make_crosses_size_aware(p, [&](int, Vec2 u, int& hint) { return p.metric_plane->pull_at(u, hint); });
    add_grids(problem_.mapped, domain_.mapped, p);
    if (p.metric_plane)
      for (PlacedSingularity& s : p.crosses.singularities) s.at = p.metric_plane->to_plane(s.at);
    if (p.crosses.index_sum_and_expected) check_index_sum(problem_, p);
  }

 private:
  PlanarDomain make_domain(MeshingSetup& p) {
    if (lines_ != nullptr) return prepare_lines(problem_, *lines_, p);
    if (model_ == nullptr) return prepare_given(problem_, std::get<GivenMesh>(problem_.model), p, given_);
    p.warnings.insert(p.warnings.end(), model_->notes.begin(), model_->notes.end());
    return mesh_by_size(problem_, *model_, hints_.spots, agreement_of(problem_, hints_), p);
  }

  /// Where nodes face each other, single edges across may be impossible.
  void seed_narrow(const CurveAgreement& agreement) {
    if (agreement.price == 0 || agreement.thin_rows) return;
    for (std::size_t p = 0; p < domain_.patches.size(); ++p)
      if (std::ranges::find(domain_.mapped, static_cast<int>(p), &MappedPatch::patch) == domain_.mapped.end())
        seed_narrow_places(domain_.patches[p]);
  }

  const MeshProblem& problem_;
  const RetryHints& hints_;
  const PlanarModel* model_;
  const LineModel* lines_;  ///< null, and no model: a mesh is given
  PlanarDomain domain_;
  std::vector<QuadPatch> given_;  ///< elements of a given mesh, by patch
  std::shared_ptr<const CrossField> given_cross_;
};

}  // namespace

std::shared_ptr<const CrossField> given_cross(const CrossSpec& spec, const Mesh& boundary, MeshingSetup& p) {
  // Far above rounding of the coordinates, and far below any feature that a mesh could show.
  constexpr double kGradientStep = 1e-6;  // over the diagonal of the domain
  if (spec.kind == CrossKind::kGradient)
    return make_gradient_cross(p.size.field, kGradientStep * diagonal(boundary));
  if (!spec.function) return spec.field;
  return sample_cross(spec.function, {Box<Vec3>::around(boundary.points)}, *p.size.field,
                      spec.where + ": the cross function", p.warnings);
}

std::unique_ptr<ModelSteps> planar_steps(const MeshProblem& problem, const RetryHints& hints) {
  return std::make_unique<PlanarSteps>(problem, hints);
}

}  // namespace delquad
