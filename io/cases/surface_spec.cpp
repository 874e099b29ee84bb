#include "io/cases/surface_spec.h"

#include <fmt/format.h>

#include "base/length_unit.h"
#include "base/located.h"
#include "delquad/error.h"
#include "geometry/surface/compound.h"
#include "geometry/surface/triangulated_model.h"
#include "io/cases/case_keys.h"

namespace delquad {
namespace {

Vec3 read_vector(const TomlTable& table, const std::string& key) {
  const std::vector<double> v = table.numbers(key);
  if (v.size() != 3)
    throw InputError(fmt::format("{}: '{}' must be three numbers [x, y, z]", table.where(key), key));
  return {v[0], v[1], v[2]};
}

MirrorPlane read_mirror(const TomlTable& table, double weld_tolerance) {
  MirrorPlane plane{read_vector(table, "point"), read_vector(table, "normal"), weld_tolerance};
  if (!(norm(plane.normal) > 0))
    throw InputError(table.where("normal") + ": the normal of the mirror's plane has no length");
  if (table.has("tolerance"))
    plane.tolerance =
        checked_weld_tolerance(table.number("tolerance"), table.where("tolerance"), "tolerance");
  plane.join = table.flag("join", plane.join);
  table.finish(mirror_keys());
  return plane;
}

}  // namespace

Compounds parse_compounds(const std::string& text, const std::string& where) {
  if (text == "all") return Compounds::kAll;
  if (text == "tangent") return Compounds::kTangent;
  throw InputError(fmt::format("{}: compound '{}': expected all or tangent", where, text));
}

SurfaceSpec read_surface_spec(const TomlTable& table) {
  SurfaceSpec spec;
  spec.where = table.where();
  if (table.kind("compound") == TomlKind::kText) {
    spec.compounds = parse_compounds(table.text("compound"), table.where("compound"));
  } else if (table.has("compound")) {
    spec.compounds = Compounds::kGroups;
    spec.groups = table.integer_lists("compound");
    for (const auto& group : spec.groups)
      if (group.size() < 2) throw InputError(table.where("compound") + ": a compound has two faces or more");
  }
  if (table.has("ignore_below")) spec.ignore_below = table.positive_number("ignore_below");
  if (table.has("merge_curves")) spec.merge_curves = table.positive_number("merge_curves");
  if (table.has("feature_angle"))
    spec.feature_angle = checked_feature_angle(table.number("feature_angle"), table.where("feature_angle"));
  if (table.has("weld_tolerance"))
    spec.weld_tolerance =
        checked_weld_tolerance(table.number("weld_tolerance"), table.where("weld_tolerance"));
  if (const auto mirror = table.optional_table("mirror"))
    spec.mirror = read_mirror(*mirror, spec.weld_tolerance.value_or(TriangulatedOptions{}.weld_tolerance));
  spec.glue = table.flag("glue", false);
  if (table.has("unit")) {
    spec.unit = table.text("unit");
    located(table.where("unit"), [&] { length_unit(spec.unit); });
  }
  table.finish(surface_keys());
  return spec;
}

}  // namespace delquad
