// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/curves/surface_input.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <utility>

#include "algorithms/fields/size_by.h"
#include "base/disjoint_sets.h"
#include "base/length_unit.h"
#include "base/located.h"
#include "base/nearest_name.h"
#include "base/text.h"
#include "delquad/error.h"
#include "features/curves/compose_size.h"
#include "features/curves/flat_model.h"
#include "features/naming/name_parts.h"
#include "features/sizes/curve_options.h"
#include "features/symmetry/symmetry_planes.h"
#include "geometry/cad/cad_reader.h"
#include "geometry/cad/example_models.h"
#include "geometry/mesh/find_crossings.h"
#include "geometry/mesh/half_edges.h"
#include "geometry/mesh/keep_elements.h"
#include "geometry/mesh/split_polygon.h"
#include "geometry/mesh/stray_points.h"
#include "geometry/planar/model_chain.h"
#include "geometry/surface/compound.h"
#include "geometry/surface/ignore_small.h"

namespace delquad {
namespace {

constexpr double kNoFeatureAngle = 180;

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

double length_of_small(const MeshProblem& problem, std::span<const Vec3> points) {
  const SurfaceSpec& spec = problem.surface;
  if (!spec.idealize || spec.ignore_below > 0) return spec.ignore_below;
  const auto limit = std::ranges::find_if(
      problem.criteria.limits, [](const CriterionLimit& l) { return l.key == "min_length" && l.on.empty(); });
  const auto refuse = [&](const char* what) {
    throw InputError(
        fmt::format("{}: parts shorter than min_length are to be left out, but {}: expected criteria with "
                    "min_length, or ignore_below with a length",
                    spec.where.empty() ? problem.where : spec.where, what));
  };
  if (problem.criteria.empty()) refuse("there are no criteria");
  if (limit == problem.criteria.limits.end()) refuse("the criteria lack min_length");
  if (!limit->in_sizes) return limit->value;
  if (!problem.size.field) refuse("min_length is relative to a size that is not known before meshing");
  double size = std::numeric_limits<double>::infinity();
  int hint = -1;
  for (const Vec3& x : points) size = std::min(size, problem.size.field->at(x, hint));
  return limit->value * size;
}

KeptNames names_that_stay(const MeshProblem& problem, const std::vector<Entity>& curves,
                          const std::vector<Entity>& regions) {
  const SurfaceSpec& spec = problem.surface;
  std::vector<std::string> known;
  for (const auto* entities : {&curves, &regions})
    for (const Entity& e : *entities) known.insert(known.end(), e.names.begin(), e.names.end());
  for (const std::string& name : spec.keep)
    if (std::ranges::find(known, name) == known.end())
      throw InputError(
          fmt::format("{}: no curve and no region is called '{}', which is to be kept{} [unknown-name]",
                      spec.where.empty() ? problem.where : spec.where, name, suggestion_or_all(name, known)));
  return {curve_options(problem.options).keep_named, spec.keep};
}

namespace {

SurfaceModel make_compounds(const MeshProblem& problem, const std::vector<FeatureBall>& kept,
                            SurfaceModel model) {
  const SurfaceSpec& spec = problem.surface;
  const CompoundOptions options = compound_options(spec);
  if (spec.compounds != Compounds::kNone) {
    const auto groups = spec.compounds == Compounds::kGroups    ? faces_of_tags(spec, model.fine)
                        : spec.compounds == Compounds::kTangent ? tangent_groups(model)
                                                                : tangent_groups(model, kNoFeatureAngle);
    model = make_compound(std::move(model), groups, options);
  }
  const KeptNames keep = names_that_stay(problem, model.fine.curves, model.fine.regions);
  if (spec.fill_holes > 0) {
    const std::size_t before = model.fine.lines.size();
    model = close_small_holes(std::move(model), {std::numbers::pi * spec.fill_holes, keep, kept});
    if (model.fine.lines.size() == before)
      model.warnings.emplace_back(fmt::format("{}: no hole up to a diameter of {} is filled",
                                              spec.where.empty() ? problem.where : spec.where,
                                              spec.fill_holes));
  }
  if (const double length = length_of_small(problem, model.fine.points); length > 0)
    model = ignore_small(std::move(model), {length, keep, kept}, options);
  return model;
}

void check_for_cad(const SurfaceSpec& spec) {
  const auto refuse = [&](const char* what) {
    throw InputError(
        fmt::format("{}: {} has no effect on a CAD model, whose faces and curves are its own: leave it out",
                    spec.where, what));
  };
  if (spec.mirror) refuse("a mirror");
  if (spec.feature_angle && spec.compounds == Compounds::kNone && spec.ignore_below == 0 && !spec.idealize)
    refuse("a feature angle without compounds");
}

/// Lengths in the unit that is asked for.
void convert(const std::string& source, const SurfaceSpec& spec, Mesh& mesh) {
  if (spec.unit.empty()) return;
  if (mesh.unit.empty())
    throw InputError(
        fmt::format("{}: {} does not say its unit, so that lengths cannot be in {}: leave it out [no-unit]",
                    spec.where, source, spec.unit));
  const double factor = length_unit(mesh.unit).metres / length_unit(spec.unit).metres;
  for (Vec3& p : mesh.points) p = factor * p;
  mesh.unit = spec.unit;
}

/// Takes the elements at stray points out; says which, nothing where there are none.
std::string leave_out_strays(Mesh& mesh) {
  const std::vector<StrayPoint> strays = stray_points(mesh);
  if (strays.empty()) return "";
  std::vector<char> is_stray(mesh.points.size(), 0);
  for (const StrayPoint& stray : strays) is_stray[stray.point] = 1;
  const auto keep = [&](auto& elements, std::vector<int>& entity_of) {
    return keep_elements(elements, entity_of, [&](std::size_t i) {
      return std::ranges::none_of(elements[i], [&](int v) { return is_stray[v] != 0; });
    });
  };
  const std::string why = describe(strays[0], mesh);
  keep(mesh.lines, mesh.line_curve);
  const std::size_t gone = keep(mesh.triangles, mesh.triangle_region) + keep(mesh.quads, mesh.quad_region);
  return fmt::format("{} {} missing: {}", counted(static_cast<long long>(gone), "element"),
                     gone == 1 ? "is" : "are", why);
}

/// Warns of parts that go through each other, or lie on each other. A part ends where three triangles meet.
void warn_of_penetrating(const std::string& source, SurfaceModel& model) {
  const Mesh& mesh = model.fine;
  DisjointSets parts(mesh.triangles.size());
  for_each_edge(sorted_half_edges(mesh), [&](std::span<const HalfEdge> edge) {
    if (edge.size() == 2) parts.join(edge[0].element, edge[1].element);
  });
  const std::vector<int> part = parts.roots();
  if (std::ranges::all_of(part, [&](int p) { return p == part[0]; })) return;
  std::map<std::pair<int, int>, Crossing> first;  // by parts
  constexpr double kContact = 1e-6;               // of the diagonal: single precision
  for (const Crossing& crossing : find_crossings(
           mesh.points, mesh.triangles, [&](int t, int u) { return part[t] == part[u]; },
           kContact * diagonal(mesh)))
    first.try_emplace(std::minmax(part[crossing.first], part[crossing.second]), crossing);
  std::vector<std::string> places;
  const auto face = [&](int t) {
    const Entity& region = mesh.regions[mesh.triangle_region[t]];
    return fmt::format("face {}{}", region.tag, region.names.empty() ? "" : " of '" + region.names[0] + "'");
  };
  for (const auto& [pair, crossing] : first)
    places.push_back(fmt::format("{} {} {} at {}", face(crossing.first), crossing.is_flat ? "on" : "through",
                                 face(crossing.second), show_point(crossing.at)));
  constexpr std::size_t kMostPlaces = 20;
  if (!places.empty())
    model.warnings.push_back(
        fmt::format("{}: {} of bodies touch or go through each other and share no nodes: {}: unite them "
                    "before, or delete copies [crossing-bodies]",
                    source, counted(std::ssize(places), "pair"), first_of(places, kMostPlaces, "; ")));
}

SurfaceModel make_surface(const MeshProblem& problem, const TriangleModel& model,
                          const std::vector<FeatureBall>& kept) {
  const SurfaceSpec& spec = problem.surface;
  if (spec.glue)
    throw InputError(spec.where +
                     ": only bodies of CAD models can be glued: unite triangulated bodies in a CAD program "
                     "[crossing-bodies]");
  ReadNotes notes = model.notes;
  Mesh triangles = model.mesh;
  const std::string missing = problem.keep_going ? leave_out_strays(triangles) : "";
  convert(model.source, spec, triangles);
  std::vector<LooseLine> points;
  for (const NamedPoint& named : triangles.named_points)
    if (!named.entity.names.empty())
      points.push_back({{triangles.points[named.point]},
                        named.entity.names,
                        fmt::format("{}: the point '{}'", model.source, named.entity.names[0])});
  triangles.named_points.clear();
  const std::string& source = model.source;
  split_quads(triangles, notes);
  TriangulatedOptions options;
  options.source = source;
  options.kept_features = kept;
  if (spec.feature_angle) options.feature_angle = *spec.feature_angle;
  if (spec.weld_tolerance) options.weld_tolerance = *spec.weld_tolerance;
  const std::string unit = triangles.unit;
  if (spec.mirror) triangles = add_mirror_image(std::move(triangles), *spec.mirror, source);
  SurfaceModel surface = make_surface_model(std::move(triangles), options);
  warn_of_penetrating(source, surface);
  name_parts(spec.names, surface);
  surface = make_compounds(problem, kept, std::move(surface));
  surface.warnings.insert(surface.warnings.begin(), notes.begin(), notes.end());
  if (!missing.empty()) {
    auto& faces = surface.fine.regions;
    surface.left_out.push_back({static_cast<int>(faces.size()), source + ": " + missing});
    faces.push_back({std::ranges::max_element(faces, {}, &Entity::tag)->tag + 1, {}});
  }
  surface.fine.unit = unit;
  surface.loose.insert(surface.loose.end(), points.begin(), points.end());
  return surface;
}

LooseLine loose_line(const EmbeddedLine& line, const std::string& where) {
  LooseLine loose{line.points, {}, line.where.empty() ? where : line.where, true, line.is_crack};
  if (!line.name.empty()) loose.names = {line.name};
  loose.where += fmt::format(": the embedded {}{}", line.points.size() == 1 ? "point" : "polyline",
                             line.name.empty() ? "" : " '" + line.name + "'");
  if (line.points.empty()) throw InputError(loose.where + " has no points");
  if (line.is_crack && line.points.size() == 1)
    throw InputError(loose.where + " is no crack: expected a polyline");
  for (const Vec3& x : line.points)
    if (!(std::isfinite(x.x) && std::isfinite(x.y) && std::isfinite(x.z)))
      throw InputError(loose.where + " has a coordinate that is not finite");
  return loose;
}

/// Regions of a planar model.
SurfaceModel make_flat(const MeshProblem& problem, const PlanarModel& model) {
  constexpr int kChords = 64;          // a curve
  constexpr double kLeastSize = 4e-3;  // in diagonals
  const double least = kLeastSize * norm(box_of(model, kChords).size());
  std::vector<Warning> warnings;
  auto asked = planar_base_size(problem.size, model, warnings);
  if (const SymmetrySpec& spec = problem.symmetry; !spec.planes.empty())
    asked = least_of_images(std::move(asked), given_planes(spec.planes, spec.where));
  SurfaceModel flat = flat_surface(
      model, *size_by([&](const Vec3& x, int& hint) { return std::max(asked->at(x, hint), least); }));
  flat.fine.unit = problem.surface.unit;
  flat.warnings.insert(flat.warnings.begin(), model.notes.begin(), model.notes.end());
  return flat;
}

/// CAD or an example.
SurfaceModel make_from_cad(const MeshProblem& problem) {
  check_for_cad(problem.surface);
  CadOptions options;
  options.unit = problem.surface.unit;
  options.keep_going = problem.keep_going;
  options.glue = problem.surface.glue;
  if (problem.surface.weld_tolerance) options.weld = *problem.surface.weld_tolerance;
  if (problem.size.field)
    options.size = [field = problem.size.field](const Vec3& x) {
      int hint = -1;
      return field->at(x, hint);
    };
  const auto* example = std::get_if<ExampleModel>(&problem.model);
  if (example != nullptr && !options.unit.empty() && options.unit != "mm")
    throw InputError(problem.surface.where + ": lengths of the examples are in mm");
  SurfaceModel model = example != nullptr ? read_example(example->name, options)
                                          : read_cad(std::get<CadModel>(problem.model), options);
  name_parts(problem.surface.names, model);
  const bool changes_faces = problem.surface.compounds != Compounds::kNone ||
                             problem.surface.ignore_below > 0 || problem.surface.idealize ||
                             problem.surface.fill_holes > 0;
  const auto unusable =
      std::ranges::find_if(model.left_out, [](const LeftOutFace& f) { return f.face >= 0; });
  if (unusable != model.left_out.end() && changes_faces)
    throw InputError(unusable->reason + "; faces cannot be joined before all can be used");
  return model;
}

}  // namespace

SurfaceModel make_surface(const MeshProblem& problem, const std::vector<FeatureBall>& kept,
                          std::shared_ptr<const SurfaceModel>& cad) {
  return located(problem.where, [&] {
    const auto* triangles = std::get_if<TriangleModel>(&problem.model);
    if (const auto* planar = std::get_if<PlanarModel>(&problem.model); planar && !cad)
      cad = std::make_shared<SurfaceModel>(make_flat(problem, *planar));
    if (triangles == nullptr && !cad) cad = std::make_shared<SurfaceModel>(make_from_cad(problem));
    SurfaceModel model =
        triangles != nullptr ? make_surface(problem, *triangles, kept) : make_compounds(problem, kept, *cad);
    for (const EmbeddedLine& line : problem.surface.embed)
      model.loose.push_back(loose_line(line, problem.surface.where));
    return model;
  });
}

SurfaceModel make_surface(const MeshProblem& problem) {
  std::shared_ptr<const SurfaceModel> cad;
  return make_surface(problem, {}, cad);
}

namespace {

/// Degrees: curves that turn by more where they meet do not go on as one. Less than what makes a corner of a
/// triangulation, since the points of a CAD model were put there.
constexpr double kSmoothTurn = 20;
/// Curves that are shorter, in sizes, are joined by default.
constexpr double kShort = 0.25;
/// A curve and its mirror image are of one length but for rounding: it should not part them where the length
/// is a round number.
constexpr double kRoundingMargin = 1 - 1e-6;

double least_at_corners(const SizeField& size, const SurfaceModel& model) {
  double least = std::numeric_limits<double>::infinity();
  int hint = -1;
  for (const int p : model.corners) least = std::min(least, size.at(model.fine.points[p], hint));
  return least;
}

/// Returns the curves whose names or numbers the problem has, and with `named` all with names.
std::vector<char> curves_that_stay(const MeshProblem& problem, const std::vector<Entity>& curves,
                                   bool named) {
  std::vector<char> stays;
  for (const Entity& curve : curves) stays.push_back(named && !curve.names.empty());
  const auto add = [&](const std::string& name) {
    for (const int c : entities_named(curves, "curve", name)) stays[c] = 1;
  };
  for (const CurveDivision& division : problem.divisions) add(division.name);
  for (const NamedSize& size : problem.size.named) add(size.name);
  return stays;
}

}  // namespace

SurfaceModel join_curves(const MeshProblem& problem, const SizeField& size, SurfaceModel model,
                         double least) {
  const std::optional<double> tolerance = problem.surface.simplify;
  // Outlines were simplified before.
  if (std::holds_alternative<PlanarModel>(problem.model) || tolerance == 0 || model.corners.empty() ||
      !problem.periodic.empty() || !problem.mapped.corners.empty())
    return model;
  if (tolerance) {
    const std::vector<char> kept = curves_that_stay(problem, model.fine.curves, false);
    model = simplify_curves(
        std::move(model), [&, hint = -1](const Vec3& x) mutable { return *tolerance * size.at(x, hint); },
        kept);
  }
  const double length = kRoundingMargin * std::max(kShort, least) * least_at_corners(size, model);
  const std::vector<char> named = curves_that_stay(problem, model.fine.curves, true);
  const std::size_t n_warnings = model.warnings.size();
  model = merge_short_curves(std::move(model), length, {.feature_angle = kSmoothTurn}, named);
  for (std::size_t i = n_warnings; i < model.warnings.size(); ++i)
    model.warnings[i].text += " (--simplify 0 keeps them)";
  return model;
}

}  // namespace delquad
