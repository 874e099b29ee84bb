// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/curves/compose_size.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "algorithms/fields/fields.h"
#include "base/estimate.h"
#include "delquad/error.h"
#include "features/divisions/divisions.h"
#include "features/sizes/named_parts.h"

namespace delquad {

std::shared_ptr<const SizeField> base_size(const SizeSpec& spec, const SampleDomain& domain,
                                           std::vector<Warning>& warnings,
                                           const std::function<std::shared_ptr<const SizeField>()>& own) {
  std::shared_ptr<const SizeField> base = spec.field;
  if (spec.function) base = sample_size(spec.function, domain, spec.where + ": the size function", warnings);
  if (spec.from_boundary || (!base && spec.sources.empty())) base = own();
  if (!spec.sources.empty()) base = make_source_size(std::move(base), spec.sources);
  return spec.max > 0 ? make_capped_size(std::move(base), spec.max) : base;
}

std::shared_ptr<const SizeField> largest_size(const SizeSpec& size, const std::string& why) {
  if (size.max > 0 && !size.from_boundary) return make_constant_size(size.max);
  throw InputError(size.where + ": " + why);
}

void check_count(double quads, const MeshProblem& problem) {
  if (quads <= static_cast<double>(problem.max_elements)) {
    if (on_estimate()) on_estimate()(quads);
    return;
  }
  const std::string count =
      std::isfinite(quads) ? fmt::format("about {:.3g} quads", quads) : "more quads than can be counted";
  throw InputError(fmt::format(
      "{}: the size asks for {}, more than the {} that are allowed (max-elements) [too-many-quads]",
      problem.size.where, count, problem.max_elements));
}

bool is_symmetric(const MeshProblem& problem) {
  return problem.symmetry.automatic || !problem.symmetry.planes.empty();
}

double expected_quads(const Mesh& fine, const SurfaceSize& size, const std::vector<FacePair>& images,
                      const CutSurface* part, const std::vector<char>& unselected) {
  std::vector<int> times(fine.regions.size(), 1);
  for (std::size_t f = 0; f < unselected.size(); ++f) times[f] = unselected[f] == 0;
  for (const FacePair& pair : images) times[pair.face] = 0, times[pair.master] = 2;
  double sum = 0;
  int hint = -1;
  for (std::size_t t = 0; t < fine.triangles.size(); ++t) {
    double quads = times[fine.triangle_region[t]] * size.quads_in(fine, static_cast<int>(t), hint);
    for (int k = 0; part != nullptr && k < part->planes.count(); ++k)
      if (!(part->half.face_planes[fine.triangle_region[t]] >> k & 1)) quads *= 2;
    sum += quads;
  }
  return sum;
}

namespace {

/// Elements per full turn that are asked for by name; of several the most.
std::vector<double> curvature_by_name(const std::vector<NamedSize>& named,
                                      const std::vector<Entity>& entities, const std::string& kind) {
  std::vector<double> per_turn(entities.size(), 0);
  for (const NamedSize& n : named)
    for (const int i : entities_named(entities, kind, n.name))
      per_turn[i] = std::max(per_turn[i], n.curvature);
  return per_turn;
}

/// Edges of curves that get curved elements turn by no more, in radians. Polynomials hardly follow more. The
/// normal of a quad between two such edges is never far from its mean.
constexpr double kCurvedEdgeTurn = std::numbers::pi / 2;

}  // namespace

WantedSize surface_size(const MeshProblem& problem, const SurfaceModel& model,
                        std::shared_ptr<const SizeField> base, const std::vector<CurveDivision>& divisions,
                        const std::vector<SizeBall>& spots, const CutSurface* cut) {
  const SizeSpec& spec = problem.size;
  WantedSize wanted;
  if (problem.order > 1 && model.projector) wanted.edge_turn = kCurvedEdgeTurn;
  wanted.base = divisions.empty() ? std::move(base) : as_divided(std::move(base), model, divisions);
  wanted.gradation = spec.gradation;
  wanted.curve_limit = sizes_beside_short_curves(model.fine, *wanted.base);
  wanted.spots = spots;
  if (!(wanted.curve_limit.empty() && spots.empty()) && !(wanted.gradation > 0))
    wanted.gradation = kShortCurveGradation;
  if (!follows_curvature(spec)) return wanted;
  wanted.curvature = std::make_shared<ModelCurvature>(model);
  wanted.per_turn = spec.curvature;
  const Mesh& whole = cut != nullptr ? cut->whole.fine : model.fine;
  wanted.face_per_turn = curvature_by_name(spec.named, whole.regions, "region");
  wanted.curve_per_turn = curvature_by_name(spec.named, whole.curves, "curve");
  if (cut != nullptr) {
    wanted.face_per_turn = most_of_faces(std::move(wanted.face_per_turn), *cut);
    wanted.curve_per_turn = most_of_curves(wanted.curve_per_turn, *cut);
  }
  // Numbers of edges count more than curvature, which of imprinted curves is noise.
  wanted.curve_per_turn.resize(model.fine.curves.size(), 0);
  for (const CurveDivision& division : divisions)
    for (const int c : entities_named(model.fine.curves, "curve", division.name))
      wanted.curve_per_turn[c] = WantedSize::kNoTurns;
  wanted.min = spec.min;
  if (!(spec.gradation > 0)) wanted.gradation = kCurvatureGradation;
  return wanted;
}

}  // namespace delquad
