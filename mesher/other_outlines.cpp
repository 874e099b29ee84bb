// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <utility>
#include <variant>

#include "features/curves/compose_size.h"
#include "features/curves/surface_input.h"
#include "features/washers/planar_washers.h"
#include "geometry/planar/join_outlines.h"
#include "geometry/planar/leave_out_small.h"
#include "geometry/planar/model_chain.h"
#include "geometry/planar/simplify_outlines.h"
#include "geometry/planar/snap_outlines.h"
#include "mesher/prepare.h"

namespace delquad {
namespace {

/// Tolerance for outlines of data, in sizes.
constexpr double kSimplify = 0.1;

/// Returns whether a change of outlines is requested, or is the default for outlines of data.
bool is_requested(const PlanarModel& model, const MetricSpec& metric, const std::optional<double>& asked) {
  if (metric.plane) return false;
  return asked ? *asked > 0 : std::ranges::any_of(model.curves, &ModelCurve::is_data);
}

/// A problem of a planar model whose outlines change.
class OutlineChanges {
 public:
  OutlineChanges(const MeshProblem& problem, const PlanarModel& model) : made_{problem}, model_(model) {}

  void snap() {
    constexpr int kChords = 64;
    const auto asked = std::exchange(made_.problem.surface.weld_tolerance, 0);
    model_ =
        snap_outlines(std::move(model_), asked.value_or(kCoincidence) * norm(box_of(model_, kChords).size()),
                      asked.has_value(), made_.warnings);
  }

  void simplify() {
    const std::optional<double> asked = std::exchange(made_.problem.surface.simplify, 0);
    std::vector<double> named(model_.curves.size(), std::numeric_limits<double>::infinity());
    for (const NamedSize& size : made_.problem.size.named)
      for (std::size_t c = 0; c < named.size(); ++c)
        if (size.size > 0 && model_.curves[c].name == size.name) named[c] = std::min(named[c], size.size);
    const OutlineTolerance tolerance = [part = asked.value_or(kSimplify), named, size = size(), hint = -1](
                                           int curve, const Vec3& x) mutable {
      return part * std::min(named[curve], size->at(x, hint));
    };
    model_ = simplify_outlines(std::move(model_), tolerance, asked.has_value(), made_.warnings);
  }

  void leave_out_small() {
    const MeshProblem& problem = made_.problem;
    std::vector<Vec3> ends;
    std::vector<Entity> curves, regions;
    for (const ModelCurve& curve : model_.curves) {
      const Vec2 end = curve.shape->point(0);
      ends.push_back({end.x, end.y, 0});
      curves.push_back({0, {curve.name}});
    }
    for (const ModelLoop& loop : model_.loops) regions.push_back({0, {loop.region}});
    const double length = length_of_small(problem, ends);
    const double hole = std::max(length, std::numbers::pi * problem.surface.fill_holes);
    model_ = delquad::leave_out_small(
        std::move(model_), {length, hole, names_that_stay(problem, curves, regions)}, made_.warnings);
    made_.problem.surface = {};
    made_.ignores_small = true;
  }

  OtherOutlines finish() {
    for (ModelCurve& curve : model_.curves) curve.is_data = false;
    const auto own = made_.problem.washers.empty() ? nullptr : size();
    made_.problem.model = std::move(model_);
    if (own) made_.problem = with_planar_washers(std::move(made_.problem), *own, made_.warnings);
    return std::move(made_);
  }

 private:
  /// As it is asked for, before curves make it smaller.
  std::shared_ptr<const SizeField> size() const {
    std::vector<Warning> of_size;
    return planar_base_size(made_.problem.size, model_, of_size);
  }

  OtherOutlines made_;
  PlanarModel model_;
};

}  // namespace

std::optional<OtherOutlines> with_other_outlines(const MeshProblem& problem) {
  const auto* model = std::get_if<PlanarModel>(&problem.model);
  if (model == nullptr) return std::nullopt;
  const SurfaceSpec& s = problem.surface;
  const bool has_small = s.ignore_below > 0 || s.idealize || s.fill_holes > 0,
             is_to_be_snapped = is_requested(*model, problem.metric, s.weld_tolerance),
             is_to_be_simplified = is_requested(*model, problem.metric, s.simplify);
  if (!has_small && !is_to_be_snapped && !is_to_be_simplified && problem.washers.empty()) return std::nullopt;
  OutlineChanges changes(problem, *model);
  if (is_to_be_snapped) changes.snap();
  if (is_to_be_simplified) changes.simplify();
  if (has_small) changes.leave_out_small();
  return changes.finish();
}

}  // namespace delquad
