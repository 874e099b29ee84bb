// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "algorithms/fields/fields.h"
#include "algorithms/fields/size_by.h"
#include "delquad/error.h"
#include "features/curves/compose_size.h"
#include "features/curves/mesh_planar_curves.h"
#include "features/divisions/divisions.h"
#include "features/layers/add_layers.h"
#include "features/seed/perturb.h"
#include "features/sizes/curvature_spots.h"
#include "features/sizes/curve_options.h"
#include "features/sizes/fine_spots.h"
#include "features/sizes/named_parts.h"
#include "features/sizes/size_warnings.h"
#include "features/symmetry/symmetry_planes.h"
#include "features/thin/gap_sizes.h"
#include "geometry/planar/model_chain.h"

namespace delquad {
namespace {

/// Up to this many boundary edges, the domain is cheap enough to be built before the number of quads is
/// known.
constexpr double kCheapEdges = 2e5;
/// The boundary edges of the coarse domain on which the number of quads is estimated beyond that.
constexpr double kCoarseEdges = 4e3;

/// Boundary edges that the size asks for, by chords: a first idea, before anything is allocated.
double rough_edges(const PlanarModel& model, const SizeField& size) {
  constexpr int kChords = 200;  // a curve
  double edges = 0;
  int hint = -1;
  for (const ModelCurve& curve : model.curves)
    for (int k = 0; k < kChords; ++k) {
      const Vec2 a = curve.shape->point(double(k) / kChords), b = curve.shape->point(double(k + 1) / kChords);
      const Vec2 m = 0.5 * (a + b);
      edges += norm(b - a) / size.at({m.x, m.y, 0}, hint);
    }
  return edges;
}

/// Refuses a hopeless size while it is still cheap: estimates the quads on a domain with coarser boundaries.
void check_count_early(const MeshProblem& problem, const PlanarModel& model,
                       const std::shared_ptr<const SizeField>& size) {
  const double edges = rough_edges(model, *size);
  if (!(edges > kCheapEdges)) return;
  std::optional<PlanarDomain> coarse;
  try {
    coarse = make_domain(model, *scaled(edges / kCoarseEdges, size));
  } catch (const InputError&) {
    // The boundary makes sense only at its full resolution, where the same check is made again.
  }
  // Each boundary edge has a quad, which has two at most, but for corners.
  check_count(coarse ? expected_quads(BackgroundMesh(coarse->patches).triangles(), *size) : edges / 2,
              problem);
}

Box<Vec3> box_in_space(const PlanarModel& model) {
  constexpr int kChords = 64;  // a curve
  const auto [low, high] = box_of(model, kChords);
  return {{low.x, low.y, 0}, {high.x, high.y, 0}};
}

double diagonal_of(const PlanarModel& model) {
  const Box<Vec3> box = box_in_space(model);
  return norm(box.high - box.low);
}

/// Places where the mesh was not sound, before the model was turned.
std::vector<LocalSize> fine_spots(const MeshProblem& problem, const std::vector<SizeBall>& spots) {
  std::vector<LocalSize> fine;
  for (const SizeBall& spot : spots) {
    const Vec2 turned{spot.at.x, spot.at.y};
    const Vec2 at = problem.seed == 0 ? turned : Rotation::by_seed(problem.seed).back(turned);
    fine.push_back({{at.x, at.y, 0}, {at.x, at.y, 0}, spot.size, spot.reach});
  }
  return fine;
}

/// A model whose curves are meshed as often as a decision on their size depends on how they were.
class SizedModel {
 public:
  SizedModel(const MeshProblem& problem, const PlanarModel& model, const CurveAgreement& agreement,
             MeshingSetup& p)
      : problem_(problem), model_(model), agreement_(agreement), p_(p) {}

  /// Meshes the curves by another size. `grid_size`: of the sides of grids, where that is another one.
  void mesh_by(std::shared_ptr<const SizeField> size,
               const std::shared_ptr<const SizeField>& grid_size = nullptr) {
    p_.size.field = std::move(size);
    check_count_early(problem_, model_, p_.size.field);
    CurveMeshOptions options;
    options.grid_size = grid_size;
    options.max_edges = static_cast<double>(problem_.max_elements);
    options.divisions = problem_.divisions;
    options.periodic = problem_.periodic;
    options.mapped = problem_.mapped;
    options.agreement = agreement_;
    auto on_curves = p_.size.field;
    if (problem_.seed != 0) on_curves = jittered(std::move(on_curves), problem_.seed, diagonal_of(model_));
    domain = make_domain(model_, *on_curves, options);
  }

  PlanarDomain domain;

 private:
  const MeshProblem& problem_;
  const PlanarModel& model_;
  const CurveAgreement agreement_;
  MeshingSetup& p_;
};

}  // namespace

std::shared_ptr<const SizeField> planar_base_size(const SizeSpec& spec, const PlanarModel& model,
                                                  std::vector<Warning>& warnings) {
  return base_size(spec, {box_in_space(model)}, warnings, [&] {
    return largest_size(
        spec, "curves have no edge lengths of their own: expected a size (a number or an expression)");
  });
}

PlanarDomain mesh_by_size(const MeshProblem& problem, const PlanarModel& model,
                          const std::vector<SizeBall>& spots, const CurveAgreement& agreement,
                          MeshingSetup& p) {
  const SizeSpec& spec = problem.size;
  PreparedSize& size = p.size;
  SizedModel sized(problem, model, agreement, p);
  const PlanarDomain& domain = sized.domain;
  size.field = planar_base_size(spec, model, p.warnings);
  const std::shared_ptr<const SizeField> base = size.field;
  sized.mesh_by(base);
  // The regions are as their curves are meshed: the second time by sizes that are nearly those wanted.
  for (int round = 0; round < 2 && !spec.named.empty(); ++round) {
    const NamedParts parts(model, domain);
    if (round == 0) warn_of_ineffective_sizes(spec.named, parts, *base, p.warnings);
    sized.mesh_by(finer_near(base, parts.spots(spec.named)));
  }
  if (const auto turns = curvature_spots(model, domain, spec, *base); !turns.empty()) {
    size.asked = size.field;
    size.adapted_to.push_back("curvature");
    sized.mesh_by(finer_near(size.field, turns));
  }
  // Sizes grow along the background mesh of the curves' edges.
  if (spec.gradation > 0) {
    p.plane.background = std::make_shared<BackgroundMesh>(domain.patches);
    sized.mesh_by(limit_gradation(size.field, p.plane.background, spec.gradation));
  }
  if (size.asked) size.curved = size.field;
  // Quads beside a fan of layers are not much larger than its quads.
  if (const auto fans = fan_spots(domain, problem.layers); !fans.empty()) {
    if (!size.asked) size.asked = size.field;
    size.adapted_to.push_back("fans of layers");
    sized.mesh_by(finer_near(size.field, fans));
  }
  // Sizes beside divided curves are the lengths of their edges.
  if (!problem.divisions.empty()) {
    if (!size.asked) size.asked = size.field;
    size.adapted_to.push_back("given edges");
    sized.mesh_by(as_divided(size.field, model, domain, problem.divisions));
  }
  // Edges are short where curves between two of their nodes are.
  const CurveOptions curves = curve_options(problem.options);
  std::vector<LocalSize> fine = short_edges(domain, *size.field, curves.thin_rows ? curves.aspect : 1);
  if (!fine.empty()) size.adapted_to.push_back("short curves");
  if (curves.gap_rows > 0) {
    const auto before = size.field;
    const auto gaps = sizes_in_gaps(before, curves.gap_rows, [&](const auto& by, const LookAtPatch& look) {
      if (by != before) sized.mesh_by(by);
      for (const PatchBoundary& patch : domain.patches) look(patch, domain.boundary.points, {});
    });
    size.field = before;
    const BackgroundMesh background(domain.patches);
    warn_of_many_rows(problem.name, curves.gap_rows, expected_quads(background.triangles(), *size.field),
                      expected_quads(background.triangles(), *finer_near(size.field, gaps)), p.warnings);
    if (!gaps.empty()) size.adapted_to.push_back("gaps between curves");
    fine.insert(fine.end(), gaps.begin(), gaps.end());
  }
  if (!spots.empty()) size.adapted_to.push_back("sound quads");
  if (!fine.empty() || !spots.empty() || !problem.divisions.empty()) {
    if (!size.asked) size.asked = size.field;
    std::vector<LocalSize> all = fine_spots(problem, spots);
    const auto grid_size = finer_near(size.field, all);
    all.insert(all.begin(), fine.begin(), fine.end());
    sized.mesh_by(finer_near(size.field, std::move(all)), grid_size);
  }
  p.plane.background = std::make_shared<BackgroundMesh>(domain.patches);
  return std::move(sized.domain);
}

}  // namespace delquad
