#include <algorithm>
#include <numbers>
#include <utility>

#include "features/curves/compose_size.h"
#include "features/divisions/divisions.h"
#include "features/sizes/named_parts.h"

namespace delquad {
namespace {

/// The growth of sizes away from curves that are shorter than the size, and from spots.
constexpr double kShortCurveGradation = 0.7;

/// Elements per full turn that are asked for by name; of several the most.
std::vector<double> curvature_by_name(const std::vector<NamedSize>& named,
                                      const std::vector<Entity>& entities, const std::string& kind) {
  std::vector<double> per_turn(entities.size(), 0);
  for (const NamedSize& n : named)
    for (const int i : entities_named(entities, kind, n.name))
      per_turn[i] = std::max(per_turn[i], n.curvature);
  return per_turn;
}

/// Edges of curves that get curved elements turn by no more, in radians: polynomials hardly follow more, and
/// of a quad between two such edges the normal is never far from its mean.
constexpr double kCurvedEdgeTurn = std::numbers::pi / 2;

}  // namespace

WantedSize surface_size(const MeshProblem& problem, const SurfaceModel& model,
                        std::shared_ptr<const SizeField> base, const std::vector<CurveDivision>& divisions,
                        const std::vector<SizeSpot>& spots, const CutSurface* cut) {
  const SizeSpec& spec = problem.size;
  WantedSize wanted;
  if (problem.order > 1 && model.projector) wanted.edge_turn = kCurvedEdgeTurn;
  wanted.base = divisions.empty() ? std::move(base) : as_divided(std::move(base), model, divisions);
  wanted.gradation = spec.gradation;
  wanted.curve_limit = sizes_beside_short_curves(model.fine, *wanted.base);
  wanted.spots = spots;
  if (!(wanted.curve_limit.empty() && spots.empty()) && !(wanted.gradation > 0))
    wanted.gradation = kShortCurveGradation;
  const bool named = std::ranges::any_of(spec.named, [](const NamedSize& n) { return n.curvature > 0; });
  if (!(spec.curvature > 0) && !named) return wanted;
  wanted.curvature = std::make_shared<ModelCurvature>(model);
  wanted.per_turn = spec.curvature;
  if (named) {
    const Mesh& whole = cut != nullptr ? cut->whole.fine : model.fine;
    wanted.face_per_turn = curvature_by_name(spec.named, whole.regions, "region");
    wanted.curve_per_turn = curvature_by_name(spec.named, whole.curves, "curve");
  }
  if (named && cut != nullptr) {
    wanted.face_per_turn = most_of_faces(std::move(wanted.face_per_turn), *cut);
    wanted.curve_per_turn = most_of_curves(wanted.curve_per_turn, *cut);
  }
  wanted.min = spec.min;
  if (!(spec.gradation > 0)) wanted.gradation = kCurvatureGradation;
  return wanted;
}

}  // namespace delquad
