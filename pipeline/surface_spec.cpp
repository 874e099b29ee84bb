#include "pipeline/surface_spec.h"

#include <fmt/format.h>

#include <algorithm>

#include "geometry/surface/compound.h"
#include "geometry/surface/triangulated_model.h"
#include "mesh/error.h"
#include "pipeline/case_keys.h"

namespace delquad {
namespace {

constexpr double kMostTolerance = 0.1;  // of the diagonal: more would weld the model to itself
constexpr double kAnyAngle = 180;

Vec3 read_vector(const TomlTable& table, const std::string& key) {
  const std::vector<double> v = table.numbers(key);
  if (v.size() != 3)
    throw InputError(fmt::format("{}: '{}' must be three numbers [x, y, z]", table.where(key), key));
  return {v[0], v[1], v[2]};
}

double checked_tolerance(double part, const std::string& key, const std::string& where) {
  if (part >= 0 && part <= kMostTolerance) return part;
  throw InputError(fmt::format("{}: {} {}: expected a part of the model's diagonal, from 0 to {}", where, key,
                               part, kMostTolerance));
}

MirrorPlane read_mirror(const TomlTable& table, double weld_tolerance) {
  MirrorPlane plane{read_vector(table, "point"), read_vector(table, "normal"), weld_tolerance};
  if (!(norm(plane.normal) > 0))
    throw InputError(table.where("normal") + ": the normal of the mirror's plane has no length");
  if (table.has("tolerance"))
    plane.tolerance = checked_tolerance(table.number("tolerance"), "tolerance", table.where("tolerance"));
  plane.join = table.flag("join", plane.join);
  table.finish(mirror_keys());
  return plane;
}

CompoundOptions compound_options(const SurfaceSpec& spec) {
  CompoundOptions options;
  if (spec.feature_angle) options.feature_angle = *spec.feature_angle;
  return options;
}

/// Indices of the faces with these tags.
std::vector<std::vector<int>> faces_of_tags(const SurfaceSpec& spec, const Mesh& mesh) {
  std::vector<std::vector<int>> groups;
  for (const std::vector<int>& tags : spec.groups) {
    auto& group = groups.emplace_back();
    for (const int tag : tags) {
      const auto at = std::find_if(mesh.regions.begin(), mesh.regions.end(),
                                   [&](const Entity& face) { return face.tag == tag; });
      if (at == mesh.regions.end()) {
        const auto [low, high] =
            std::minmax_element(mesh.regions.begin(), mesh.regions.end(),
                                [](const Entity& a, const Entity& b) { return a.tag < b.tag; });
        throw InputError(fmt::format(
            "{}: compound {}: the model has no face {}: expected numbers of its {} faces, from {} "
            "to {}",
            spec.where, groups.size(), tag, mesh.regions.size(), low->tag, high->tag));
      }
      group.push_back(static_cast<int>(at - mesh.regions.begin()));
    }
  }
  return groups;
}

}  // namespace

Compounds parse_compounds(const std::string& text, const std::string& where) {
  if (text == "all") return Compounds::kAll;
  if (text == "tangent") return Compounds::kTangent;
  throw InputError(fmt::format("{}: compound '{}': expected all or tangent", where, text));
}

double checked_feature_angle(double degrees, const std::string& where) {
  if (degrees > 0 && degrees <= kAnyAngle) return degrees;
  throw InputError(fmt::format("{}: feature angle {}: expected above 0 and at most {} degrees", where,
                               degrees, kAnyAngle));
}

double checked_weld_tolerance(double part, const std::string& where) {
  return checked_tolerance(part, "weld tolerance", where);
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
  if (table.has("merge_curves")) spec.merge_curves = table.positive_number("merge_curves");
  if (table.has("feature_angle"))
    spec.feature_angle = checked_feature_angle(table.number("feature_angle"), table.where("feature_angle"));
  if (table.has("weld_tolerance"))
    spec.weld_tolerance =
        checked_weld_tolerance(table.number("weld_tolerance"), table.where("weld_tolerance"));
  if (const auto mirror = table.optional_table("mirror"))
    spec.mirror = read_mirror(*mirror, spec.weld_tolerance.value_or(TriangulatedOptions{}.weld_tolerance));
  table.finish(surface_keys());
  return spec;
}

SurfaceModel make_model(const SurfaceSpec& spec, Mesh triangles, const std::string& source) {
  TriangulatedOptions options;
  options.source = source;
  if (spec.feature_angle) options.feature_angle = *spec.feature_angle;
  if (spec.weld_tolerance) options.weld_tolerance = *spec.weld_tolerance;
  if (spec.mirror) triangles = add_mirror_image(std::move(triangles), *spec.mirror, source);
  return make_compounds(spec, make_surface_model(std::move(triangles), options));
}

SurfaceModel make_compounds(const SurfaceSpec& spec, SurfaceModel model) {
  const CompoundOptions options = compound_options(spec);
  if (spec.compounds == Compounds::kAll) {
    const auto groups = tangent_groups(model, kAnyAngle);
    model = make_compound(std::move(model), groups, options);
  } else if (spec.compounds == Compounds::kTangent) {
    const auto groups = tangent_groups(model);
    model = make_compound(std::move(model), groups, options);
  } else if (spec.compounds == Compounds::kGroups) {
    const auto groups = faces_of_tags(spec, model.fine);
    model = make_compound(std::move(model), groups, options);
  }
  if (spec.merge_curves > 0) model = merge_short_curves(std::move(model), spec.merge_curves, options);
  return model;
}

void check_for_cad(const SurfaceSpec& spec) {
  const auto refuse = [&](const char* what) {
    throw InputError(fmt::format("{}: {} has no effect on a CAD model, whose faces and curves are its own",
                                 spec.where, what));
  };
  if (spec.weld_tolerance) refuse("a weld tolerance");
  if (spec.mirror) refuse("a mirror");
  if (spec.feature_angle && spec.compounds == Compounds::kNone && spec.merge_curves == 0)
    refuse("a feature angle without compounds");
}

}  // namespace delquad
