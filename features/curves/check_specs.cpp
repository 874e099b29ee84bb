#include <fmt/format.h>

#include <cmath>
#include <string>

#include "base/length_unit.h"
#include "base/located.h"
#include "features/curves/compose_size.h"
#include "features/curves/surface_input.h"
#include "fields/fields.h"
#include "geometry/surface/triangulated_model.h"

namespace delquad {
namespace {

/// Refuses a number that is neither 0, for "none", nor finite and positive.
void check_length(double value, const std::string& what, const std::string& where) {
  if (!(value >= 0) || !std::isfinite(value))
    throw InputError(fmt::format("{}: {} {}: expected a finite number above 0, or 0 for none", where, what,
                                 std::isnan(value) ? "NaN" : fmt::format("{}", value)));
}

void check(const NamedSize& n) {
  check_length(n.size, "the size of '" + n.name + "'", n.where);
  check_length(n.reach, "the reach of '" + n.name + "'", n.where);
  if (!(n.growth > 0) || !std::isfinite(n.growth))
    throw InputError(fmt::format("{}: sizes grow away from '{}' by {}: expected a finite number above 0",
                                 n.where, n.name, n.growth));
  check_length(n.curvature, "the curvature of '" + n.name + "'", n.where);
  if (n.curvature > 0 && n.curvature < kLeastPerTurn)
    throw InputError(
        fmt::format("{}: the curvature of '{}' is {}: expected at least {} elements per full turn", n.where,
                    n.name, n.curvature, kLeastPerTurn));
  if (!(n.size > 0) && !(n.curvature > 0))
    throw InputError(fmt::format("{}: '{}' has neither a size nor a curvature", n.where, n.name));
}

}  // namespace

void check_size(const SizeSpec& size) {
  if ((size.field != nullptr) + (size.function != nullptr) + size.from_boundary > 1)
    throw InputError(size.where + ": a size is a field, a function or the boundary's: expected one of them");
  for (const NamedSize& named : size.named) check(named);
  check_length(size.gradation, "gradation", size.where);
  check_length(size.curvature, "curvature", size.where);
  if (size.curvature > 0 && size.curvature < kLeastPerTurn)
    throw InputError(fmt::format("{}: curvature {}: expected at least {} elements per full turn", size.where,
                                 size.curvature, kLeastPerTurn));
  check_length(size.min, "the least size", size.where);
  check_length(size.max, "the largest size", size.where);
  check_size_limits(size.curvature, size.min, size.max, size.where);
}

void check_surface(const SurfaceSpec& surface, const std::string& where) {
  check_length(surface.ignore_below, "the length below which faces and curves are ignored", where);
  check_length(surface.merge_curves, "the length of curves that are merged", where);
  if (surface.feature_angle) checked_feature_angle(*surface.feature_angle, where);
  if (surface.weld_tolerance) checked_weld_tolerance(*surface.weld_tolerance, where);
  if (!surface.unit.empty()) located(where, [&] { length_unit(surface.unit); });
  if (surface.compounds == Compounds::kGroups) {
    if (surface.groups.empty()) throw InputError(where + ": compounds by groups need a group of faces");
    for (const auto& group : surface.groups)
      if (group.size() < 2) throw InputError(where + ": a compound has two faces or more");
  }
  if (!surface.mirror) return;
  const MirrorPlane& mirror = *surface.mirror;
  if (!std::isfinite(norm(mirror.point))) throw InputError(where + ": the mirror's point is not finite");
  if (!(norm(mirror.normal) > 0) || !std::isfinite(norm(mirror.normal)))
    throw InputError(where + ": the normal of the mirror's plane has no finite length");
  checked_weld_tolerance(mirror.tolerance, where, "the mirror's tolerance");
}

}  // namespace delquad
