// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesher/prepare.h"

#include <fmt/format.h>

#include <cmath>
#include <set>
#include <variant>

#include "algorithms/fields/fields.h"
#include "base/text.h"
#include "features/curves/compose_size.h"
#include "geometry/mesh/check_mesh.h"
#include "geometry/mesh/model_kind.h"
#include "geometry/planar/model_chain.h"
#include "io/cases/check_described.h"
#include "io/cases/problem_record.h"

namespace delquad {
namespace {

void check(const PlanarModel& model, const std::string& where) {
  if (model.loops.empty())
    throw InputError(where + ": the model has no loops: nothing bounds a domain [empty-domain]");
  for (std::size_t i = 0; i < model.curves.size(); ++i)
    if (!model.curves[i].shape)
      throw InputError(fmt::format("{}: curve {} of the model has no shape", where, i + 1));
  constexpr double kMost = 1e60;  // fourth powers of lengths are finite
  for (std::size_t i = 0; i < model.curves.size(); ++i) {
    std::vector<double> at = model.curves[i].shape->fixed_parameters();
    at.insert(at.end(), {0, 0.5, 1});
    for (const double t : at)
      if (const Vec2 x = model.curves[i].shape->point(t); !(norm(x) < kMost))
        throw InputError(fmt::format("{}: {} goes to {}: expected coordinates below {:g}", where,
                                     curve_label(model, static_cast<int>(i)), show_point(x), kMost));
  }
  for (std::size_t i = 0; i < model.loops.size(); ++i)
    for (const int curve : model.loops[i].curves)
      if (curve < 0 || curve >= static_cast<int>(model.curves.size()))
        throw InputError(fmt::format("{}: loop {} has curve {}: there are {}, counted from 0", where, i + 1,
                                     curve, model.curves.size()));
}

void check_given(const Mesh& mesh, const std::string& source) {
  require_readable(mesh, source);
  require_straight(mesh, source);
}

void check(const LineModel& model, const std::string&) { check_given(model.mesh, model.source); }

/// Checks a TriangleModel or a GivenMesh.
void check(const auto& model, const std::string&) {
  check_given(model.mesh, model.source);
  if (model.mesh.triangles.empty() && model.mesh.quads.empty())
    throw InputError(model.source + ": holds neither triangles nor quads");
}

void check(const CadModel& model, const std::string& where) {
  if (model.file.empty() && model.bytes.empty())
    throw InputError(where + ": a CAD model has neither a file nor bytes: expected one of them");
}

void check(const ModelFile& model, const std::string& where) {
  throw InputError(where + ": '" + model.path.string() + "' was not read");
}

void check(const ExampleModel& model, const std::string& where) {
  if (model.name.empty())
    throw InputError(where + ": the example has no name: expected one of 'delquad example --list'");
}

void check(const CrossSpec& cross, bool has_metric) {
  const int given = (cross.field != nullptr) + (cross.function != nullptr);
  if (cross.kind == CrossKind::kField && given != 1)
    throw InputError(fmt::format("{}: crosses by a field need a field or a function, and have {}",
                                 cross.where, given == 0 ? "none" : "both"));
  if ((cross.kind == CrossKind::kMade) != (cross.maker != nullptr))
    throw InputError(cross.where + ": a maker of crosses and the kind 'made' come together");
  if (cross.kind == CrossKind::kMetric && !has_metric)
    throw InputError(cross.where +
                     ": directions of a metric are asked for, and there is no metric, or none "
                     "with directions");
  if (cross.kind != CrossKind::kField && given > 0)
    throw InputError(cross.where + ": a field or a function of crosses is given, and another kind asked for");
}

/// Refuses requests that need a model whose curves are meshed.
void check_curves_are_meshed(const MeshProblem& problem) {
  if (is_symmetric(problem))
    throw InputError(problem.symmetry.where +
                     ": symmetry needs a planar model of curves or a surface: leave it out");
  if (!problem.mapped.asks()) return;
  const std::string& where =
      problem.mapped.corners.empty() || problem.mapped.automatic || !problem.mapped.names.empty()
          ? problem.mapped.where
          : problem.mapped.corners[0].where;
  throw InputError(where + ": grids need a planar model of curves or a surface: leave them out");
}

/// Refuses requests that are impossible if lines are kept.
void check_lines_are_free(const MeshProblem& problem, const std::string& source) {
  if (!problem.divisions.empty())
    throw InputError(fmt::format("{}: '{}' cannot be divided: the lines of {} are kept as they are",
                                 problem.divisions[0].where, problem.divisions[0].name, source));
  if (!problem.periodic.empty())
    throw InputError(
        fmt::format("{}: '{}' cannot get the nodes of '{}': the lines of {} are kept as they are",
                    problem.periodic[0].where, problem.periodic[0].to, problem.periodic[0].from, source));
}

/// Refuses options of surfaces, and names them; a feature angle only unless `angle_may_be`. The options need
/// the `wanted` kind of model, and the model `is` another.
void refuse_surface_options(const MeshProblem& problem, bool angle_may_be, const char* is,
                            const char* wanted) {
  const SurfaceSpec& s = problem.surface;
  std::set<std::string> allowed = {"keep", "groups"};
  if (angle_may_be) allowed.insert("feature_angle");
  const auto* planar = std::get_if<PlanarModel>(&problem.model);
  if (planar != nullptr && (planar->source.ends_with(".dxf") || planar->source.ends_with(".DXF")))
    allowed.insert("unit");
  if (kind_of(problem.model).has_outlines())
    allowed.insert({"ignore_below", "idealize", "simplify", "fill_holes", "weld_tolerance"});
  std::vector<std::string> given = given_keys(s);
  std::erase_if(given, [&](const std::string& key) { return allowed.contains(key); });
  if (!given.empty())
    throw InputError(fmt::format("{}: {}: {} {} for {}", s.where.empty() ? problem.where : s.where, is,
                                 fmt::join(given, ", "), given.size() == 1 ? "is" : "are", wanted));
}

/// Refuses requests that would change a mesh in space before its stages, and requests for surfaces in the
/// plane.
void check_no_surface(const MeshProblem& problem, bool in_space) {
  refuse_surface_options(
      problem, in_space,
      in_space ? "a mesh that is given keeps its faces, lines and unit" : "the model is planar",
      in_space ? "models" : "surfaces");
  if (!kind_of(problem.model).has_outlines() && follows_curvature(problem.size))
    throw InputError(problem.size.where +
                     ": sizes by curvature need a model of curves or a surface: leave 'curvature' out");
}

/// Refuses to leave out small parts if other requests name curves by number, or pair them.
void check_small_outlines(const MeshProblem& problem) {
  const SurfaceSpec& s = problem.surface;
  if (s.ignore_below == 0 && !s.idealize && s.fill_holes == 0) return;
  const auto refuse = [&](const std::string& other) {
    throw InputError(fmt::format("{}: small parts of planar models cannot be left out beside {}",
                                 s.where.empty() ? problem.where : s.where, other));
  };
  if (is_symmetric(problem)) refuse("symmetry (" + problem.symmetry.where + ")");
  if (!problem.periodic.empty()) refuse("periodic sides (" + problem.periodic[0].where + ")");
  if (!problem.divisions.empty()) refuse("numbers of edges (" + problem.divisions[0].where + ")");
  if (!problem.mapped.corners.empty()) refuse("corners of grids (" + problem.mapped.corners[0].where + ")");
  if (problem.metric.plane) refuse("a metric (" + problem.metric.where + ")");
}

/// Refuses symmetry beside periodic sides: mirrored nodes would not match the nodes of periodic curves.
void check_symmetry_alone(const MeshProblem& problem) {
  if (is_symmetric(problem) && !problem.periodic.empty())
    throw InputError(fmt::format("{}: symmetry does not go with periodic sides ({}): expected one of the two",
                                 problem.symmetry.where, problem.periodic[0].where));
}

/// Nodes on the outline of selected faces depend on the model alone. Mid-surfaces select faces, too.
void check_faces(const MeshProblem& problem) {
  const SurfaceSpec& s = problem.surface;
  if (s.faces.empty() && !s.midsurface) return;
  const char* other = is_symmetric(problem)       ? "symmetry"
                      : !problem.periodic.empty() ? "periodic sides"
                      : !problem.layers.empty()   ? "layers"
                      : !s.midsurface             ? nullptr
                      : !s.faces.empty()          ? "selected faces"
                      : problem.order > 1         ? "curved elements"
                                                  : nullptr;
  if (other != nullptr)
    throw InputError(fmt::format("{}: {} do not go with {}: expected one of the two",
                                 s.where.empty() ? problem.where : s.where,
                                 s.midsurface ? "mid-surfaces" : "selected faces", other));
}

/// Refuses ranges that share more than an end. `Spec`: WasherSpec or FilletRows.
template <class Spec>
void check_overlaps(const std::vector<Spec>& specs, const char* what) {
  for (const Spec& s : specs)
    for (const Spec* other = specs.data(); other != &s; ++other)
      if (s.least < other->most && other->least < s.most)
        throw InputError(fmt::format("{}: {} from {} to {} overlap those from {} to {} ({})", s.where, what,
                                     s.least, s.most, other->least, other->most, other->where));
}

/// Refuses washers and rows across fillets that the model, symmetry or periodic sides do not allow.
void check_washers(const MeshProblem& problem) {
  check_overlaps(problem.washers, "diameters");
  check_overlaps(problem.fillet_rows, "radii");
  const ModelKind kind = kind_of(problem.model);
  if (!problem.fillet_rows.empty() && (kind.in_plane || kind.kept))
    throw InputError(problem.fillet_rows[0].where + ": rows across fillets need a CAD model: leave them out");
  if (problem.washers.empty() && problem.fillet_rows.empty()) return;
  const std::string& where =
      problem.washers.empty() ? problem.fillet_rows[0].where : problem.washers[0].where;
  if (kind.kept)
    throw InputError(where + ": washers need a planar model of curves or a surface: leave them out");
  if (!kind.in_plane && (is_symmetric(problem) || !problem.periodic.empty()))
    throw InputError(where +
                     ": rows around holes and across fillets of a surface go neither with symmetry nor with "
                     "periodic sides");
}

/// Refuses requests that do not go with the kind of model.
void check_kind(const MeshProblem& problem) {
  const ModelKind kind = kind_of(problem.model);
  if (kind.in_plane) {
    check_no_surface(problem, false);
    check_small_outlines(problem);
    check_symmetry_alone(problem);
  }
  if (kind.kept == nullptr) return;
  check_lines_are_free(problem, *kind.kept);
  check_curves_are_meshed(problem);
  if (kind.is_given && !problem.layers.empty())
    throw InputError(problem.layers[0].where +
                     ": a given mesh gets no layers: leave them out, or mesh its model");
  if (!kind.in_plane) check_no_surface(problem, true);
}

}  // namespace

void check_problem(const MeshProblem& problem) {
  check_described(problem, problem.where);
  std::visit([&](const auto& model) { check(model, problem.where); }, problem.model);
  const bool in_plane = kind_of(problem.model).in_plane;
  if (!problem.layers.empty() && !in_plane && problem.metric.asks())
    throw InputError(problem.layers[0].where + ": layers on a surface do not go with a metric");
  for (const SymmetryPlane& plane : problem.symmetry.planes)
    if (in_plane && !(std::hypot(plane.normal.x, plane.normal.y) > 0))
      throw InputError(
          problem.symmetry.where +
          ": the normal of a plane of symmetry has no length in the plane: expected x or y other than 0");
  check(problem.cross, problem.metric.asks());
  check_washers(problem);
  check_faces(problem);
  check_kind(problem);
}

}  // namespace delquad
