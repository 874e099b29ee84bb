#include "features/sizes/join_short_curves.h"

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "features/sizes/curve_options.h"
#include "features/sizes/named_parts.h"
#include "geometry/surface/compound.h"

namespace delquad {
namespace {

/// Degrees: curves that turn by more where they meet do not go on as one. Less than what makes a corner of a
/// triangulation, since the points of a CAD model were put there.
constexpr double kSmoothTurn = 20;
/// A curve and its mirror image are of one length but for rounding: it should not part them where the length
/// is a round number.
constexpr double kBelowRound = 1 - 1e-6;

double least_at_corners(const SizeField& size, const SurfaceModel& model) {
  double least = std::numeric_limits<double>::infinity();
  int hint = -1;
  for (const int p : model.corners) least = std::min(least, size.at(model.fine.points[p], hint));
  return least;
}

std::vector<char> named_curves(const MeshProblem& problem, const std::vector<Entity>& curves) {
  std::vector<char> named;
  for (const Entity& curve : curves) named.push_back(curve.names.empty() ? 0 : 1);
  const auto add = [&](const std::string& name) {
    for (const int c : entities_named(curves, "curve", name)) named[c] = 1;
  };
  for (const CurveDivision& division : problem.divisions) add(division.name);
  for (const NamedSize& size : problem.size.named) add(size.name);
  return named;
}

}  // namespace

SurfaceModel join_short_curves(const MeshProblem& problem, const SizeField& size, SurfaceModel model) {
  const double part = curve_options(problem.options).join_below;
  if (part == 0 || model.corners.empty() || !problem.periodic.empty() || !problem.mapped.corners.empty())
    return model;
  const double length = kBelowRound * part * least_at_corners(size, model);
  const std::vector<char> named = named_curves(problem, model.fine.curves);
  const std::size_t n_warnings = model.warnings.size();
  model =
      merge_short_curves(std::move(model), length, {.feature_angle = kSmoothTurn}, ShortRest::kSilent, named);
  for (std::size_t i = n_warnings; i < model.warnings.size(); ++i)
    model.warnings[i].text += " (curves.join_below = 0 keeps them)";
  return model;
}

}  // namespace delquad
