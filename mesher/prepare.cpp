#include "mesher/prepare.h"
#include "features/layers/add_layers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <variant>

#include "base/activity.h"
#include "base/located.h"
#include "base/stopwatch.h"
#include "features/crosses/size_aware.h"
#include "features/given/given_domain.h"
#include "features/given/given_surface.h"
#include "features/given/named_domain.h"
#include "features/grids/add_grids.h"
#include "features/layers/planar_layers.h"
#include "features/seed/perturb.h"
#include "features/sizes/fine_spots.h"
#include "features/sizes/gap_warning.h"
#include "features/sizes/imprint_named.h"
#include "features/sizes/join_short_curves.h"
#include "features/sizes/named_parts.h"
#include "features/sizes/size_warnings.h"
#include "features/symmetry/symmetric_size.h"
#include "fields/fields.h"
#include "fields/sampled_fields.h"
#include "geometry/planar/boundary_report.h"
#include "geometry/planar/curve_divisions.h"
#include "geometry/planar/symmetry.h"
#include "mesher/check_problem.h"
#include "mesher/prepare_surface.h"
#include "mesher/surface_input.h"

namespace delquad {
namespace {

/// Central differences for the direction of grad delta, in diagonals of the domain: far above rounding of the
/// coordinates, far below any feature that a mesh could show.
constexpr double kGradientStep = 1e-6;
/// Up to this many boundary edges, the domain is cheap enough to be built before the number of quads is
/// known.
constexpr double kCheapEdges = 2e5;
/// The boundary edges of the coarse domain on which the number of quads is estimated beyond that.
constexpr double kCoarseEdges = 4e3;

/// The field without its gradation limit; `boundary` makes the one that follows the boundary's edges. A
/// function is sampled on `domain`.
template <class F>
std::shared_ptr<const SizeField> make_size(const SizeSpec& spec, const SampleDomain& domain,
                                           std::vector<Warning>& warnings, F&& boundary) {
  std::shared_ptr<const SizeField> base = spec.field;
  if (spec.function) base = sample_size(spec.function, domain, spec.where + ": the size function", warnings);
  if (spec.from_boundary || (!base && spec.sources.empty())) base = boundary();
  if (!spec.sources.empty()) base = make_source_size(std::move(base), spec.sources);
  return spec.max > 0 ? make_capped_size(std::move(base), spec.max) : base;
}

/// What stands in for a base that was not given.
std::shared_ptr<const SizeField> largest_size(const SizeSpec& size, const std::string& why) {
  if (size.max > 0 && !size.from_boundary) return make_constant_size(size.max);
  throw InputError(size.where + ": " + why);
}

PointSize as_function(std::shared_ptr<const SizeField> size, double scale = 1) {
  return
      [size = std::move(size), scale, hint = -1](const Vec3& x) mutable { return scale * size->at(x, hint); };
}

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

void check_count(double quads, const MeshProblem& problem) {
  if (quads <= static_cast<double>(problem.max_elements)) return;
  const std::string count =
      std::isfinite(quads) ? fmt::format("about {:.3g} quads", quads) : "more quads than can be counted";
  throw InputError(fmt::format("{}: the size asks for {}, more than the {} that are allowed (max-elements)",
                               problem.size.where, count, problem.max_elements));
}

/// Refuses a hopeless size while it is still cheap: estimates the quads on a domain with coarser boundaries.
void check_count_early(const MeshProblem& problem, const PlanarModel& model,
                       const std::shared_ptr<const SizeField>& size) {
  const double edges = rough_edges(model, *size);
  if (!(edges > kCheapEdges)) return;
  std::optional<PlanarDomain> coarse;
  try {
    coarse = make_domain(model, as_function(size, edges / kCoarseEdges));
  } catch (const InputError&) {
    // The boundary makes sense only at its full resolution, where the same check is made again.
  }
  // Each boundary edge has a quad, which has two at most, but for corners.
  check_count(coarse ? expected_quads(BackgroundMesh(coarse->patches), *size) : edges / 2, problem);
}

Box<Vec3> box_of(const PlanarModel& model) {
  constexpr int kPoints = 64;  // a curve
  std::vector<Vec3> points;
  for (const ModelCurve& curve : model.curves)
    for (int k = 0; k <= kPoints; ++k) {
      const Vec2 p = curve.shape->point(double(k) / kPoints);
      points.push_back({p.x, p.y, 0});
    }
  return Box<Vec3>::around(points);
}

double diagonal_of(const PlanarModel& model) {
  const Box<Vec3> box = box_of(model);
  return norm(box.high - box.low);
}

PlanarDomain mesh_model(const MeshProblem& problem, const PlanarModel& model,
                        const std::shared_ptr<const SizeField>& size,
                        const std::shared_ptr<const SizeField>& grid_size = nullptr) {
  CurveMeshOptions options;
  if (grid_size) options.grid_size = as_function(grid_size);
  options.max_edges = static_cast<double>(problem.max_elements);
  options.divisions = problem.divisions;
  options.periodic = problem.periodic;
  options.mapped = problem.mapped;
  options.symmetry = problem.symmetry;
  const auto on_curves = problem.seed == 0 ? size : jittered(size, problem.seed, diagonal_of(model));
  return make_domain(model, as_function(on_curves), options);
}

/// Of each curve, whether a division names it.
std::vector<char> divided_curves(const PlanarModel& model, const std::vector<CurveDivision>& divisions) {
  std::vector<char> divided(model.curves.size(), 0);
  for (const CurveDivision& division : divisions)
    for (std::size_t c = 0; c < divided.size(); ++c)
      if (names_curve(division, {model.curves[c].name}, static_cast<int>(c) + 1)) divided[c] = 1;
  return divided;
}

/// Places where the mesh was not sound, before the model was turned.
std::vector<FineSpot> fine_spots(const MeshProblem& problem, const std::vector<SizeSpot>& spots) {
  std::vector<FineSpot> fine;
  for (const SizeSpot& spot : spots) {
    const Vec2 turned{spot.at.x, spot.at.y};
    const Vec2 at = problem.seed == 0 ? turned : Rotation::by_seed(problem.seed).back(turned);
    fine.push_back({{at.x, at.y, 0}, {at.x, at.y, 0}, spot.size, spot.reach});
  }
  return fine;
}

bool is_symmetric(const MeshProblem& problem) {
  return problem.symmetry.automatic || !problem.symmetry.planes.empty();
}

/// Those that are given or found.
std::vector<SymmetryPlane> planes_of(const MeshProblem& problem, const PlanarModel& model) {
  if (!is_symmetric(problem)) return {};
  const std::optional<Symmetry> symmetry = find_symmetry(model, problem.symmetry);
  return symmetry ? symmetry->planes() : std::vector<SymmetryPlane>{};
}

PlanarDomain prepare_model(const MeshProblem& problem, const PlanarModel& model,
                           const std::vector<SizeSpot>& spots, PreparedProblem& p) {
  const SizeSpec& spec = problem.size;
  p.size.field = make_size(spec, {box_of(model)}, p.warnings, [&] {
    return largest_size(
        spec, "curves have no edge lengths of their own: expected a size (a number or an expression)");
  });
  p.symmetry = planes_of(problem, model);
  const auto with_images = [&](std::shared_ptr<const SizeField> size) {
    return p.symmetry.empty() ? size : least_of_images(std::move(size), SymmetryPlanes(p.symmetry));
  };
  p.size.field = with_images(std::move(p.size.field));
  check_count_early(problem, model, p.size.field);
  PlanarDomain domain = mesh_model(problem, model, p.size.field);
  // The regions are as their curves are meshed: the second time by sizes that are nearly those wanted.
  const std::shared_ptr<const SizeField> base = p.size.field;
  for (int round = 0; round < 2 && !spec.named.empty(); ++round) {
    const NamedParts parts(model, domain);
    if (round == 0) warn_of_idle_sizes(spec.named, parts, *base, p.warnings);
    p.size.field = with_images(finer_near(base, parts.spots(spec.named)));
    check_count_early(problem, model, p.size.field);
    domain = mesh_model(problem, model, p.size.field);
  }
  if (spec.gradation > 0) {
    p.plane.background = std::make_shared<BackgroundMesh>(domain.patches);
    p.size.field = limit_gradation(p.size.field, p.plane.background, spec.gradation);
    check_count_early(problem, model, p.size.field);
    domain = mesh_model(problem, model, p.size.field);
  }
  if (!problem.divisions.empty()) {
    p.size.asked = p.size.field;
    p.size.field = as_near(p.size.field, edges_of(domain, divided_curves(model, problem.divisions)));
    p.size.adapted_to.push_back("given edges");
    domain = mesh_model(problem, model, p.size.field);
  }
  const std::vector<FineSpot> fine = short_edges(domain, *p.size.field);
  if (!fine.empty()) p.size.adapted_to.push_back("short curves");
  if (!spots.empty()) p.size.adapted_to.push_back("sound quads");
  if (!fine.empty() || !spots.empty() || !problem.divisions.empty()) {
    if (!p.size.asked) p.size.asked = p.size.field;
    std::vector<FineSpot> all = fine_spots(problem, spots);
    const auto grid_size = finer_near(p.size.field, all);
    all.insert(all.begin(), fine.begin(), fine.end());
    p.size.field = finer_near(p.size.field, std::move(all));
    check_count_early(problem, model, p.size.field);
    domain = mesh_model(problem, model, p.size.field, grid_size);
  }
  p.plane.background = std::make_shared<BackgroundMesh>(domain.patches);
  return domain;
}

/// Refuses what is for models whose curves are meshed.
void check_curves_are_meshed(const MeshProblem& problem) {
  if (is_symmetric(problem))
    throw InputError(problem.symmetry.where +
                     ": planes of symmetry are for planar models of curves and for surfaces");
  if (!problem.mapped.asks()) return;
  const std::string& where =
      problem.mapped.corners.empty() || problem.mapped.automatic || !problem.mapped.names.empty()
          ? problem.mapped.where
          : problem.mapped.corners[0].where;
  throw InputError(where + ": grids are for planar models of curves and for surfaces");
}

/// What cannot be where lines are kept.
void check_lines_are_free(const MeshProblem& problem, const std::string& source) {
  if (!problem.divisions.empty())
    throw InputError(fmt::format("{}: '{}' cannot be divided: the lines of {} are kept as they are",
                                 problem.divisions[0].where, problem.divisions[0].name, source));
  if (!problem.periodic.empty())
    throw InputError(
        fmt::format("{}: '{}' cannot get the nodes of '{}': the lines of {} are kept as they are",
                    problem.periodic[0].where, problem.periodic[0].to, problem.periodic[0].from, source));
}

PlanarDomain prepare_lines(const MeshProblem& problem, const LineModel& model, PreparedProblem& p) {
  const Mesh& mesh = model.mesh;
  check_lines_are_free(problem, model.source);
  check_curves_are_meshed(problem);
  if (mesh.lines.empty())
    throw InputError(model.source + ": holds no line elements: expected the boundary of a planar domain");
  if (!mesh.triangles.empty() || !mesh.quads.empty())
    p.warnings.push_back(
        fmt::format("{}: {} triangles and {} quads are left out: only lines count as boundary", model.source,
                    mesh.triangles.size(), mesh.quads.size()));
  PlanarDomain domain = make_named_domain(mesh, model.surfaces, model.source);
  const SizeSpec& spec = problem.size;
  p.plane.background = std::make_shared<BackgroundMesh>(domain.patches);
  p.size.field = make_size(spec, {Box<Vec3>::around(domain.boundary.points)}, p.warnings,
                           [&] { return make_boundary_size(p.plane.background, domain.boundary); });
  if (!spec.named.empty()) {
    const NamedParts parts(domain);
    warn_of_idle_sizes(spec.named, parts, *p.size.field, p.warnings);
    p.size.field = finer_near(p.size.field, parts.spots(spec.named));
  }
  if (spec.gradation > 0) p.size.field = limit_gradation(p.size.field, p.plane.background, spec.gradation);
  if (has_single_points(mesh)) {
    const PointSize size_at = as_function(p.size.field);
    domain = make_named_domain(mesh, model.surfaces, model.source, &size_at);
    p.plane.background = std::make_shared<BackgroundMesh>(domain.patches);
  }
  return domain;
}

/// `given`: receives what the patches hold.
PlanarDomain prepare_given(const MeshProblem& problem, const GivenMesh& model, PreparedProblem& p,
                           std::vector<QuadPatch>& given) {
  p.warnings.insert(p.warnings.end(), model.notes.begin(), model.notes.end());
  GivenDomain domain = make_given_domain(model);
  p.warnings.insert(p.warnings.end(), domain.warnings.begin(), domain.warnings.end());
  p.plane.background = std::make_shared<BackgroundMesh>(domain.domain.patches);
  p.size.field = make_size(problem.size, {Box<Vec3>::around(domain.domain.boundary.points)}, p.warnings,
                           [&]() -> std::shared_ptr<const SizeField> {
                             if (problem.size.from_boundary)
                               return make_boundary_size(p.plane.background, edges_of_patches(domain.domain));
                             return make_nodal_size(model.mesh, sizes_of_elements(model.mesh, model.source));
                           });
  if (problem.size.gradation > 0)
    p.size.field = limit_gradation(p.size.field, p.plane.background, problem.size.gradation);
  for (const std::string& line : odd_boundaries(domain.domain))
    p.warnings.push_back({"regions with an odd number of boundary edges", 0, line});
  given = std::move(domain.elements);
  return std::move(domain.domain);
}

/// Says so when the indices of a cross field do not add up to the Euler characteristic.
void check_index_sum(const MeshProblem& problem, PreparedProblem& p) {
  const auto [sum, expected] = *p.crosses.index_sum_and_expected;
  if (sum == expected) return;
  p.warnings.push_back(
      fmt::format("{}: the indices of the cross field add up to {}/4, but the domain's Euler "
                  "characteristic is {}/4",
                  problem.name, sum, expected));
}

/// The field of crosses that the problem has; null: none.
std::shared_ptr<const CrossField> given_cross(const CrossSpec& spec, const Mesh& boundary,
                                              PreparedProblem& p) {
  if (!spec.function) return spec.field;
  return sample_cross(spec.function, {Box<Vec3>::around(boundary.points)}, *p.size.field,
                      spec.where + ": the cross function", p.warnings);
}

/// The field of the whole domain.
std::shared_ptr<const CrossField> make_cross(const MeshProblem& problem,
                                             const std::shared_ptr<const CrossField>& given,
                                             PreparedProblem& p) {
  const CrossSpec& cross = problem.cross;
  if (cross.kind == CrossKind::kGradient)
    return make_gradient_cross(p.size.field, kGradientStep * diagonal(p.boundary));
  if (cross.kind == CrossKind::kField)
    return problem.seed == 0 ? given : rotated(given, Rotation::by_seed(problem.seed));
  auto field = std::make_shared<HarmonicCrossField>(p.plane.background);
  for (const Singularity& s : field->singularities())
    p.crosses.singularities.push_back({{s.at.x, s.at.y, 0}, s.index});
  p.crosses.index_sum_and_expected = {field->index_sum(), 4 * field->euler_characteristic()};
  return field;
}

/// Turns domain, elements and size by the problem's seed.
void turn(const MeshProblem& problem, PlanarDomain& domain, std::vector<QuadPatch>& given,
          PreparedProblem& p) {
  const Rotation rotation = Rotation::by_seed(problem.seed);
  rotate(rotation, domain);
  for (QuadPatch& patch : given)
    for (Vec2& point : patch.points) point = rotation(point);
  p.plane.background = std::make_shared<BackgroundMesh>(domain.patches);
  p.size.field = rotated(std::move(p.size.field), rotation);
  if (p.size.asked) p.size.asked = rotated(std::move(p.size.asked), rotation);
  for (PatchImage& image : domain.images)
    image.motion = [motion = std::move(image.motion), rotation](Vec2 x) {
      return rotation(motion(rotation.back(x)));
    };
}

PreparedProblem prepare_surface_problem(const MeshProblem& problem, const Refinement& refinement) {
  const Stopwatch reading;
  const DoingStage stage("reading");
  std::vector<FeatureBall> kept_features;
  if (refinement.keep_features)
    for (const SizeSpot& spot : refinement.spots) kept_features.push_back({spot.at, spot.reach});
  Refinement with_cad = refinement;
  std::shared_ptr<const SurfaceModel>& cad = with_cad.cad;
  SurfaceModel model = cad ? *cad : make_surface(problem, kept_features);
  if (!cad && model.projector) cad = std::make_shared<SurfaceModel>(model);
  const TimeSpent read = reading.time();
  const SampleDomain domain = {Box<Vec3>::around(model.fine.points), &model.fine};
  std::vector<Warning> warnings;
  auto size = make_size(problem.size, domain, warnings, [&] {
    return largest_size(problem.size, problem.size.from_boundary
                                          ? "'boundary' extends the lengths of a planar boundary that is "
                                            "kept; a surface's curves are meshed anew: expected a size (a "
                                            "number or an expression)"
                                          : "a surface needs a size (a number or an expression)");
  });
  model = join_short_curves(problem, *size, std::move(model));
  size = imprint_named(problem.size.named, std::move(size), model, warnings);
  PreparedProblem p = prepare_surface(
      problem, std::move(model), size, [&](double quads) { check_count(quads, problem); }, with_cad);
  p.times.insert(p.times.begin(), {"read", read});
  p.warnings.insert(p.warnings.begin(), warnings.begin(), warnings.end());
  return p;
}

/// Refuses what would change a mesh in space before words begin.
void check_given_in_space(const MeshProblem& problem, const GivenMesh& given) {
  check_lines_are_free(problem, given.source);
  check_curves_are_meshed(problem);
  if (!problem.layers.empty())
    throw InputError(problem.layers[0].where + ": a mesh that is given gets no layers");
  const SurfaceSpec& s = problem.surface;
  if (s.compounds != Compounds::kNone || s.merge_curves > 0 || s.ignore_below > 0 || s.weld_tolerance ||
      s.mirror || s.glue || !s.unit.empty() || !s.embed.empty())
    throw InputError(
        (s.where.empty() ? problem.where : s.where) +
        ": a mesh that is given keeps its faces, lines and unit: compounds, welding, gluing, mirrors, units, "
        "embedded lines and lengths below which entities are ignored are for models");
  if (problem.size.curvature > 0 ||
      std::ranges::any_of(problem.size.named, [](const NamedSize& n) { return n.curvature > 0; }))
    throw InputError(problem.size.where + ": sizes by curvature are for models of surfaces");
}

PreparedProblem prepare_given_in_space(const MeshProblem& problem, const GivenMesh& given) {
  check_given_in_space(problem, given);
  const Stopwatch reading;
  const DoingStage stage("reading");
  GivenSurface surface = located(problem.where, [&] {
    return make_given_surface(given, problem.surface.feature_angle.value_or(kGivenFeatureAngle));
  });
  const Mesh& fine = surface.model.fine;
  std::vector<Warning> warnings(given.notes.begin(), given.notes.end());
  auto size =
      make_size(problem.size, {Box<Vec3>::around(fine.points), &fine}, warnings,
                [&]() -> std::shared_ptr<const SizeField> {
                  if (problem.size.from_boundary)
                    throw InputError(problem.size.where +
                                     ": 'boundary' extends the lengths of a planar boundary: expected "
                                     "no size (that of the elements), a number or an expression");
                  return make_nodal_size(given.mesh, sizes_of_elements(given.mesh, given.source));
                });
  if (!problem.size.named.empty()) size = finer_near(size, NamedParts(given.mesh).spots(problem.size.named));
  const TimeSpent read = reading.time();
  PreparedProblem p = prepare_given_surface(problem, std::move(surface), given.mesh, size,
                                            [&](double quads) { check_count(quads, problem); });
  p.times.insert(p.times.begin(), {"read", read});
  p.warnings.insert(p.warnings.begin(), warnings.begin(), warnings.end());
  return p;
}

/// Refuses what is for surfaces.
void check_planar(const MeshProblem& problem) {
  const SurfaceSpec& s = problem.surface;
  if (s.compounds != Compounds::kNone || s.merge_curves > 0 || s.ignore_below > 0 || s.feature_angle ||
      s.weld_tolerance || s.mirror || s.glue || !s.unit.empty() || !s.embed.empty())
    throw InputError(
        (s.where.empty() ? problem.where : s.where) +
        ": the model is planar: compounds, feature angles, welding, gluing, mirrors, units, lines "
        "embedded in space and lengths below which entities are ignored are for surfaces");
  if (problem.size.curvature > 0 ||
      std::ranges::any_of(problem.size.named, [](const NamedSize& n) { return n.curvature > 0; }))
    throw InputError(problem.size.where +
                     ": sizes by curvature are for surfaces, and this is a planar domain");
}

/// Mirror images have the nodes of the other side, and not those of periodic curves.
void check_symmetry_alone(const MeshProblem& problem) {
  if (is_symmetric(problem) && !problem.periodic.empty())
    throw InputError(fmt::format("{}: symmetry does not go with periodic sides ({}): expected one of the two",
                                 problem.symmetry.where, problem.periodic[0].where));
}

/// Cross field and patches.
void prepare_patches(const MeshProblem& problem, const std::shared_ptr<const CrossField>& given_cross,
                     PlanarDomain&& domain, std::vector<QuadPatch>&& given, PreparedProblem& p) {
  const Stopwatch fields;
  const DoingStage making_fields("fields");
  const auto cross = make_cross(problem, given_cross, p);
  const double z = p.boundary.points[0].z;
  const auto size = std::make_shared<PlanarSize>(p.size.field, z);
  for (std::size_t i = 0; i < domain.patches.size(); ++i)
    p.patches.push_back({std::move(domain.patches[i]),
                         domain.patch_region[i],
                         cross,
                         size,
                         [z](Vec2 u, int&) {
                           return Vec3{u.x, u.y, z};
                         },
                         {}});
  for (std::size_t i = 0; i < given.size(); ++i) p.patches[i].given = std::move(given[i]);
  for (PatchImage& image : domain.images) p.patches[image.patch].image = std::move(image);
  add_grids(problem.mapped, domain.mapped, p);
  if (problem.cross.kind == CrossKind::kSizeAware) make_crosses_size_aware(p);
  if (p.crosses.index_sum_and_expected) check_index_sum(problem, p);
  p.times.emplace_back("fields", fields.time());
}

PlanarDomain planar_domain(const MeshProblem& problem, const Refinement& refinement,
                           std::vector<QuadPatch>& given, PreparedProblem& p) {
  if (const auto* model = std::get_if<PlanarModel>(&problem.model))
    return prepare_model(problem, *model, refinement.spots, p);
  const auto* start = std::get_if<GivenMesh>(&problem.model);
  if (start == nullptr) return prepare_lines(problem, std::get<LineModel>(problem.model), p);
  check_lines_are_free(problem, start->source);
  check_curves_are_meshed(problem);
  if (!problem.layers.empty())
    throw InputError(problem.layers[0].where + ": a mesh that is given gets no layers");
  return prepare_given(problem, *start, p, given);
}

PreparedProblem prepare_planar(const MeshProblem& problem, const Refinement& refinement) {
  check_planar(problem);
  check_symmetry_alone(problem);
  const auto* model = std::get_if<PlanarModel>(&problem.model);
  PreparedProblem p = with_settings_of(problem);
  const Stopwatch watch;
  const DoingStage meshing_curves("boundary");
  std::vector<QuadPatch> given;
  PlanarDomain domain = planar_domain(problem, refinement, given, p);
  for (const std::string& note : domain.notes) p.warnings.emplace_back(note);
  if (!std::holds_alternative<GivenMesh>(problem.model)) warn_of_gaps(domain, p.warnings);
  if (!problem.layers.empty()) put_layers(problem, domain, p);
  if (std::holds_alternative<LineModel>(problem.model))
    for (const std::string& line : odd_boundaries(domain))
      p.warnings.push_back({"regions with an odd number of boundary edges", 0, line});
  p.size.expected_quads =
      expected_quads(*p.plane.background, *p.size.field) + (p.layers ? p.layers->count.quads : 0);
  check_count(p.size.expected_quads, problem);
  warn_of_large_size(*p.size.field, domain.boundary, p.warnings);
  if (model != nullptr) warn_of_coarse_turns(*model, domain, p.warnings);
  const auto cross = given_cross(problem.cross, domain.boundary, p);
  if (problem.seed != 0) turn(problem, domain, given, p);
  p.boundary = std::move(domain.boundary);
  p.plane.curve_places = std::move(domain.places);
  p.plane.curve_shapes = std::move(domain.curve_shapes);
  p.times.emplace_back("curves", watch.time());
  prepare_patches(problem, cross, std::move(domain), std::move(given), p);
  return p;
}

}  // namespace

PreparedProblem with_settings_of(const MeshProblem& problem) {
  PreparedProblem p;
  p.settings.name = problem.name;
  p.settings.where = problem.where;
  p.settings.options = problem.options;
  p.settings.max_elements = problem.max_elements;
  p.settings.keep_going = problem.keep_going;
  p.settings.order = problem.order;
  return p;
}

namespace {

/// Refuses what images of meshes have no nodes for.
void check_order(const PreparedProblem& p) {
  if (p.settings.order == 1 || !p.surface) return;
  const char* other = p.surface->given                     ? "a mesh that is given"
                      : p.surface->mirrored                ? "planes of symmetry of a surface"
                      : !p.boundary.periodic_faces.empty() ? "periodic faces"
                                                           : nullptr;
  if (other != nullptr)
    throw InputError(fmt::format("{}: elements of order {} do not go with {}: expected order 1",
                                 p.settings.where, p.settings.order, other));
}

PreparedProblem prepare_unchecked(const MeshProblem& problem, const Refinement& refinement) {
  if (const auto* given = std::get_if<GivenMesh>(&problem.model);
      given != nullptr && is_in_space(given->mesh))
    return prepare_given_in_space(problem, *given);
  const bool is_planar = std::holds_alternative<PlanarModel>(problem.model) ||
                         std::holds_alternative<LineModel>(problem.model) ||
                         std::holds_alternative<GivenMesh>(problem.model);
  return is_planar ? prepare_planar(problem, refinement) : prepare_surface_problem(problem, refinement);
}

}  // namespace

PreparedProblem prepare(const MeshProblem& problem, const Refinement& refinement) {
  check_problem(problem);
  PreparedProblem prepared = prepare_unchecked(problem, refinement);
  check_order(prepared);
  return prepared;
}

}  // namespace delquad
